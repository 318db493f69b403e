// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where one revolution of a lidar ends and the next begins.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// A revolution starts where the angle passes from a full turn to 0, at most once in half a turn:
/// packets overlap by a fraction of a degree when the motor's speed varies, and around zero that
/// must not start two sweeps. Cost: O(1). Context: one at a time.
class TurnCutter {
 public:
  /// Precondition: 2 <= full_turn <= 2^30.
  explicit constexpr TurnCutter(std::uint32_t full_turn) : full_turn_(full_turn) {}

  /// True for the first angle, in [0, full_turn), of a revolution.
  bool passes_zero(std::uint32_t angle);

 private:
  std::uint32_t full_turn_;
  std::uint32_t last_angle_ = 0;
  std::int32_t since_start_ = 0;  ///< angle travelled since the last start
  bool has_last_ = false;
};

}  // namespace picolo::inline v0
