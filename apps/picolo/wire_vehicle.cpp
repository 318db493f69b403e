// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "wire_vehicle.hpp"

#include <numbers>

#include "picolo/simulated/log_config.hpp"

namespace picolo::tool {
namespace {

constexpr Duration kSyncPeriod = 10ms;

}  // namespace

sim::LogPlayerConfig player_config() {
  sim::LogPlayerConfig config;
  // so fine that the wheels' odometry is the log's: whatever differs comes from the chain
  config.script.metres_per_count = 2e-6;
  config.think_time = 400ms;  // a wide search and a map update end within it
  return config;
}

ControllerConfig controller_config(const ReplayInput& input, const ReplaySettings& settings) {
  const sim::WheelScriptConfig script = player_config().script;
  // Corrections that would be contradictions ten times a second are in order here, as they are in
  // direct replay.
  ControllerConfig config = on_a_log({}, !settings.map.empty());
  config.drive.counts_per_revolution = 300'000.0;
  config.drive.left_radius_m =
      script.metres_per_count * config.drive.counts_per_revolution / (2.0 * std::numbers::pi);
  config.drive.right_radius_m = config.drive.left_radius_m;
  config.drive.track_m = script.track_m;
  config.undistort.base_T_lidar = input.scans.front().base_T_lidar;
  config.undistort.limits = input.scans.front().limits;
  config.localiser = settings.localiser;
  config.start_map_T_base = settings.map_T_start.value_or(input.scans.front().odom_T_base);
  // of a computer, not of a microcontroller
  config.work.max_returns = 4096;
  config.work.max_point_iterations = 20'000;
  config.work.max_rays = 2048;
  config.work.max_search_slices = 64;
  return config;
}

CanopenWheelsConfig wheels_config() {
  const sim::WheelPairConfig pair = player_config().wheels;
  CanopenWheelsConfig config = two_cia402_drives(pair.left.node, pair.right.node);
  config.produce_sync = true;
  config.sync_period = kSyncPeriod;
  return config;
}

RecordedBeams beams_of(const ReplayInput& input) {
  RecordedBeams all;
  all.reserve(input.scans.size());
  for (const ReplayScan& scan : input.scans) {
    std::vector<sim::RecordedBeam>& beams = all.emplace_back();
    for (const RangeReturn& beam : scan.returns) {
      beams.push_back({scan.limits.contains(beam.range_m) ? beam.range_m : 0.0F, beam.bearing_rad});
    }
  }
  return all;
}

std::vector<sim::LogStep> steps_of(const ReplayInput& input, const RecordedBeams& beams) {
  std::vector<sim::LogStep> steps;
  for (std::size_t i = 0; i < input.scans.size(); ++i) {
    steps.push_back({input.scans[i].odom_T_base, beams[i]});
  }
  return steps;
}

}  // namespace picolo::tool
