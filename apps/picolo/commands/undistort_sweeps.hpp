// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Undistorts every sweep of a recording and counts how many cells the points occupy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>

#include "picolo/host/carmen.hpp"
#include "picolo/host/trajectory.hpp"

namespace picolo::tool {

struct UndistortSettings {
  Pose2d base_T_lidar{0.21, 0.0, std::numbers::pi};
  double cell_m = 0.03;
  double min_yaw_rate_radps = 0.3;  ///< sweeps of a vehicle that turns slower are not counted
  double max_range_m = 1000.0;
  [[nodiscard]] bool valid() const {
    return cell_m > 0.0 && min_yaw_rate_radps >= 0.0 && max_range_m > 0.0;
  }
};

/// (floor(x / cell), floor(y / cell)) in the odometry frame.
using Cells = std::set<std::pair<std::int64_t, std::int64_t>>;

struct UndistortResult {
  std::size_t sweeps_counted = 0;
  std::size_t sweeps_slow = 0;       ///< turned slower than asked
  std::size_t sweeps_uncovered = 0;  ///< odometry does not reach over the whole sweep
  std::size_t returns_counted = 0;
  Cells before;  ///< each sweep taken as one instant, that of its first beam
  Cells after;   ///< each return moved by the pose at its own time; over the same returns
  host::Trajectory odometry;
};

/// The yaw rate of a sweep is that of the first odometry record at or after its stamp.
[[nodiscard]] UndistortResult undistort_sweeps(const host::CarmenLog& log,
                                               const UndistortSettings& settings);

}  // namespace picolo::tool
