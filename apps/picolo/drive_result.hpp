// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a drive gives, however it was driven: replayed, through wires, or simulated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "picolo/host/json.hpp"
#include "picolo/host/map_file.hpp"
#include "picolo/host/trajectory.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::tool {

/// How long a task of the cycle took, in processor time of this machine.
struct TaskTiming {
  std::string name;
  double median_us = 0.0;
  double worst_us = 0.0;
};

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
  std::vector<TaskTiming> tasks;
  host::OccupancyImage map;
};

/// "scans", "matched", "outcomes".
void add_counts(const DriveResult& drive, host::Json& json);
/// {"p50", "p99"}.
[[nodiscard]] host::Json quantiles(const std::vector<double>& values);

/// Reports whether the drive may be used: at least half of its scans matched.
[[nodiscard]] bool usable(const DriveResult& drive);

}  // namespace picolo::tool
