// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "drive_result.hpp"

#include "picolo/host/quantile.hpp"

namespace picolo::tool {

host::Json outcomes_json(const LocaliserCounters& counters) {
  host::Json outcomes = host::Json::object();
  for (int i = 0; i < kMatchOutcomes; ++i) {
    outcomes[to_string(static_cast<MatchOutcome>(i))] = counters.outcomes[i];
  }
  return outcomes;
}

host::Json quantiles(const std::vector<double>& values) {
  return {{"p50", host::quantile(values, 0.50)}, {"p99", host::quantile(values, 0.99)}};
}

void move_into_frame(const Pose2d& frame_T_map, DriveResult& drive) {
  for (host::TrajectoryPose& pose : drive.trajectory) { pose.pose = frame_T_map * pose.pose; }
  drive.map.origin_x_m += frame_T_map.x_m;
  drive.map.origin_y_m += frame_T_map.y_m;
}

bool usable(const DriveResult& drive) {
  // the first scan only starts the map
  return drive.trajectory.size() < 2 ||
         2 * std::size_t{drive.counters.matched} >= drive.trajectory.size() - 1;
}

}  // namespace picolo::tool
