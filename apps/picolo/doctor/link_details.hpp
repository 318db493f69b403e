// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the kernel knows of a CAN interface (rtnetlink).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "picolo/hal/can_bus.hpp"

namespace picolo::tool {

struct LinkDetails {
  bool is_up = false;
  std::string kind;  ///< "can", "vcan", ...; empty: a driver without one
  std::optional<std::uint32_t> bit_rate;
  std::optional<std::uint32_t> restart_ms;
  CanState state = CanState::active;
};

/// Nothing: no such interface, or the kernel does not answer.
[[nodiscard]] std::optional<LinkDetails> link_details(const std::string& name);

}  // namespace picolo::tool
