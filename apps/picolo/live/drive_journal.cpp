// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/drive_journal.hpp"

#include <fmt/format.h>

namespace picolo::tool {
namespace {

constexpr std::uint64_t kCyclesPerPose = 20;

void add_pose(Hash& hash, const Pose2d& pose) {
  hash.add(pose.x_m);
  hash.add(pose.y_m);
  hash.add(pose.theta_rad);
}

}  // namespace

bool DriveJournal::add(const PoseEstimate& estimate, Timestamp now) {
  ++cycles_;
  hash_.add(std::int64_t{estimate.stamp.time_since_epoch().count()});
  add_pose(hash_, estimate.map_T_base);
  add_pose(hash_, estimate.odom_T_base);
  for (std::size_t i = 0; i < 3; ++i) { hash_.add(estimate.match_covariance(i, i)); }
  hash_.add(static_cast<std::uint32_t>(estimate.state));
  hash_.add(static_cast<std::uint32_t>(estimate.reason));
  if (estimate.matches > 0 && cycles_ % kCyclesPerPose == 0) {
    const double stamp_s = to_seconds_f64(estimate.stamp.time_since_epoch());
    trajectory_.push_back({stamp_s, estimate.map_T_base});
    odometry_.push_back({stamp_s, estimate.odom_T_base});
  }
  if (estimate.state == state_) { return false; }
  changes_.push_back({to_seconds_f64(now - start_), state_, estimate.state, estimate.reason});
  state_ = estimate.state;
  return true;
}

std::string DriveJournal::hash() const {
  return fmt::format("{:016x}", hash_.value());
}

host::Json DriveJournal::changes_json() const {
  host::Json json = host::Json::array();
  for (const StateChange& change : changes_) {
    json.push_back({{"t_s", change.since_start_s},
                    {"from", to_string(change.from)},
                    {"to", to_string(change.to)},
                    {"reason", to_string(change.reason)}});
  }
  return json;
}

}  // namespace picolo::tool
