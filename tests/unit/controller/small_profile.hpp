// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A profile for tests, and what a lidar in the furnished room sees.
#pragma once

#include <cstddef>
#include <numbers>

#include "picolo/core/time.hpp"
#include "picolo/sensing/range_return.hpp"
#include "picolo/sensing/wheel_ticks.hpp"
#include "support/walls.hpp"

namespace picolo::test {

struct SmallProfile {
  static constexpr const char* kName = "small";
  static constexpr int kWidth = 128;
  static constexpr int kHeight = 128;
  static constexpr float kCell_m = 0.1F;
  static constexpr int kFieldRadius = 5;
  static constexpr std::size_t kReturns = 180;
};

inline constexpr int kBeams = 180;
inline constexpr Duration kSweepPeriod = 90ms;  // 0.5 ms a beam

/// Beam `index`, counted from the start of the first sweep, of a lidar that stands at the origin of
/// base.
inline RangeReading beam(Timestamp start, int index, const Pose2d& world_T_base) {
  static const std::vector<Wall> kRoom = furnished_room();
  const int k = index % kBeams;
  const double bearing = -std::numbers::pi + 2.0 * std::numbers::pi * k / kBeams;
  const double range =
      cast(kRoom, world_T_base.x_m, world_T_base.y_m, world_T_base.theta_rad + bearing);
  return {.stamp = start + index * 500us,
          .range_m = static_cast<float>(range),
          .bearing_rad = static_cast<float>(bearing),
          .starts_sweep = k == 0};
}

/// Both wheels at the same count.
inline WheelTicks ticks_at(Timestamp stamp, std::int64_t left, std::int64_t right) {
  return {.stamp = stamp, .ticks = {left, right}};
}

}  // namespace picolo::test
