// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Angles of the wires to bearings.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// An angle that lidars count clockwise, in units of a turn / full_turn, as a counter-clockwise
/// bearing in [-pi, pi]. Any angle is taken modulo the turn. Precondition: full_turn in 2..2^30.
[[nodiscard]] float clockwise_bearing_rad(std::int32_t angle, std::int32_t full_turn);

}  // namespace picolo::inline v0
