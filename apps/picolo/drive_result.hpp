// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a replayed drive gives, directly or through wires.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "health_log.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/map_file.hpp"
#include "picolo/host/trajectory.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::tool {

struct DriveResult {
  host::Trajectory trajectory;  ///< map_T_base, one a scan
  host::Trajectory odometry;    ///< odom_T_base of the same scans
  host::Trajectory truth;       ///< reference poses in a frame of their own; may be empty
  std::string truth_name;       ///< for the legend
  LocaliserCounters counters{};
  std::uint64_t heap_calls = 0;
  std::vector<double> match_us;  ///< one a matched scan; empty when not measured
  std::vector<double> total_us;  ///< undistortion, match and map update; one a scan
  std::vector<double> iterations;
  host::OccupancyImage map;
  HealthLog health;
};

/// Poses and map into the frame of a map that was given (see GivenMap).
void move_into_frame(const Pose2d& frame_T_map, DriveResult& drive);

/// How often each outcome of a match came, by name.
[[nodiscard]] host::Json outcomes_json(const LocaliserCounters& counters);
/// {"p50", "p99"}.
[[nodiscard]] host::Json quantiles(const std::vector<double>& values);

/// Reports whether the drive may be used: at least half of its scans matched.
[[nodiscard]] bool usable(const DriveResult& drive);

}  // namespace picolo::tool
