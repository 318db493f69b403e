// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two formats of candump: "(stamp) can0 181#3842" and "can0  RX - -  181   [2]  38 42".
#pragma once

#include <optional>
#include <string_view>

#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0::devices {

/// Stamps are those of the log (0 where it has none). Nothing when the line is no classic CAN
/// frame: CAN FD ("##"), error frames, comments, damage.
[[nodiscard]] std::optional<CanFrame> parse_candump(std::string_view line);

}  // namespace picolo::inline v0::devices
