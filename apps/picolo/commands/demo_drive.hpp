// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A simulated drive through the whole chain: wire bytes, drivers, executive, pose.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "picolo/host/map_file.hpp"
#include "picolo/host/trajectory.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::tool {

struct DemoSettings {
  int seconds = 240;
  std::uint64_t seed = 1;
  /// Not empty: everything that arrives is written there. Heap calls and times of tasks are not
  /// measured then.
  std::string record;
};

/// How long one task of the cycle took on this machine, over all its runs, most of which find
/// nothing to do.
struct TaskTime {
  std::string name;
  double median_us = 0.0;
  double worst_us = 0.0;
};

struct DemoResult {
  host::Trajectory
      trajectory;  ///< published poses, one every 100 ms from the first accepted match on
  host::Trajectory odometry;  ///< of the same instants, as are the true ones
  host::Trajectory truth;     ///< in the controller's map frame
  host::OccupancyImage map;
  LocaliserCounters counters{};
  std::uint64_t heap_calls = 0;  ///< of the cycle, the simulation around it included
  std::vector<TaskTime> tasks;
  double tracking_share = 0.0;                    ///< of the published poses
  HealthState state = HealthState::initialising;  ///< at the end
  HealthReason reason = HealthReason::starting;
};

/// `progress` is called with the simulated seconds that have passed. The result depends on the
/// settings alone, but for the times.
[[nodiscard]] DemoResult drive_demo(const DemoSettings& settings,
                                    const std::function<void(std::size_t)>& progress);

}  // namespace picolo::tool
