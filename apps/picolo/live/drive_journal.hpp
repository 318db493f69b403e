// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a drive leaves behind: poses, changes of state, and a hash over every cycle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "picolo/core/hash.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/trajectory.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::tool {

struct StateChange {
  double since_start_s = 0.0;
  HealthState from = HealthState::initialising;
  HealthState to = HealthState::initialising;
  HealthReason reason = HealthReason::none;
};

class DriveJournal {
 public:
  explicit DriveJournal(Timestamp start) : start_(start) {}

  /// After every cycle. True when the state changed.
  bool add(const PoseEstimate& estimate, Timestamp now);

  /// Published poses from the first match on, one in 20 cycles.
  [[nodiscard]] const host::Trajectory& trajectory() const { return trajectory_; }
  [[nodiscard]] const host::Trajectory& odometry() const { return odometry_; }
  [[nodiscard]] const std::vector<StateChange>& changes() const { return changes_; }
  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }
  /// Over stamp, pose, odometry, covariance and state of every cycle.
  [[nodiscard]] std::string hash() const;
  [[nodiscard]] host::Json changes_json() const;

 private:
  Timestamp start_;
  host::Trajectory trajectory_;
  host::Trajectory odometry_;
  std::vector<StateChange> changes_;
  HealthState state_ = HealthState::initialising;
  std::uint64_t cycles_ = 0;
  Hash hash_;
};

}  // namespace picolo::tool
