// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Two drivers on one bus must not listen to the same identifier: a CANopen TPDO 0x181 is what an
/// ODrive of node 12 calls its heartbeat.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/hal/can_filter.hpp"

namespace picolo::inline v0 {

struct CanListener {
  const char* name = "";
  std::span<const CanFilter> filters{};
};

struct CanOverlap {
  const char* first = "";
  const char* second = "";
  CanFilter filter{};  ///< of the first
};

/// The first identifier that two listeners both want. `not_ready`: there is none. Cost: O(filters
/// squared). Context: configuration.
[[nodiscard]] Result<CanOverlap> find_overlap(std::span<const CanListener> listeners);

}  // namespace picolo::inline v0
