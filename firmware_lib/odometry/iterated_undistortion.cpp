// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/iterated_undistortion.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

bool within(const Pose2f& pose, float limit_m, float limit_rad) {
  return hypotenuse(pose.x_m, pose.y_m) <= limit_m && pose.theta_rad <= limit_rad &&
         pose.theta_rad >= -limit_rad;
}

bool is_usable(MatchOutcome outcome) {
  return outcome == MatchOutcome::converged || outcome == MatchOutcome::iteration_limit;
}

/// anchor_T_base over the sweep: the IMU's motion with its share of the correction.
Status fill_corrected(const PoseBufferCore& imu_poses, const Sweep& sweep, Timestamp anchor,
                      Timestamp middle, const Pose2d& correction, PoseBufferCore& corrected) {
  corrected.clear();
  const Result<Pose2d> at_anchor = imu_poses.at(anchor);
  if (!at_anchor) { return at_anchor.status(); }
  const std::int64_t duration_us = (sweep.last_stamp - sweep.stamp).count();
  const std::int64_t segments = std::clamp<std::int64_t>(
      duration_us / 5000 + 1, 1, static_cast<std::int64_t>(IteratedUndistortionCore::kPoses) - 1);
  const double per_second = 1.0 / to_seconds_f64(middle - anchor);
  Timestamp last = sweep.stamp - Duration{1};
  for (std::int64_t i = 0; i <= segments; ++i) {
    const Timestamp stamp = sweep.stamp + Duration{duration_us * i / segments};
    if (stamp <= last) { continue; }  // a sweep shorter than its segments
    last = stamp;
    const Result<Pose2d> at = imu_poses.at(stamp);
    if (!at) { return at.status(); }
    const double share = per_second * to_seconds_f64(stamp - anchor);
    const Pose2d anchor_T_base =
        between(*at_anchor, *at) * interpolate(Pose2d{}, correction, share);
    const Status status = corrected.push({stamp, anchor_T_base});
    if (status != Status::ok) { return status; }
  }
  return Status::ok;
}

}  // namespace

Status IteratedUndistortionCore::begin(const UndistortConfig& undistort, const Sweep& sweep,
                                       const PoseBufferCore& imu_poses,
                                       const DistanceFieldView& field, const MatchAnchor& anchor) {
  phase_ = Phase::idle;
  report_ = {};
  middle_ = sweep.stamp + (sweep.last_stamp - sweep.stamp) / 2;
  if (!config_.valid() || anchor.stamp >= middle_) { return Status::invalid_argument; }
  undistort_ = undistort;
  undistort_.reference = SweepReference::stamp;
  undistort_.reference_stamp = middle_;
  undistort_.frame = SweepFrame::base;
  sweep_ = sweep;
  imu_poses_ = &imu_poses;
  field_ = field;
  anchor_ = anchor;
  const Result<Pose2d> at_end = imu_poses.at(sweep.last_stamp);
  if (!at_end) { return at_end.status(); }
  const Result<Pose2d> at_anchor = imu_poses.at(anchor.stamp);
  if (!at_anchor) { return at_anchor.status(); }
  const Result<Pose2d> at_middle = imu_poses.at(middle_);
  if (!at_middle) { return at_middle.status(); }
  anchor_T_imu_middle_ = between(*at_anchor, *at_middle);
  return start_round(Phase::undistorting);
}

MatchAnchor IteratedUndistortionCore::anchor() const {
  const Pose2f anchor_T_base = to_f32(undistorter_.result().odom_T_base);
  return {middle_, report_.believed ? report_.match.pose : anchor_.window_T_base * anchor_T_base};
}

Status IteratedUndistortionCore::start_round(Phase phase) {
  phase_ = Phase::idle;
  Status status = fill_corrected(*imu_poses_, sweep_, anchor_.stamp, middle_,
                                 to_f64(report_.correction), corrected_);
  if (status != Status::ok) { return status; }
  status = undistorter_.begin(undistort_, sweep_);
  if (status != Status::ok) { return status; }
  phase_ = phase;
  return Status::ok;
}

Status IteratedUndistortionCore::step(std::size_t max_returns) {
  Status status = Status::invalid_argument;
  switch (phase_) {
    case Phase::idle: break;
    case Phase::undistorting:
    case Phase::last_undistorting:
      status = undistorter_.step(corrected_, max_returns);
      if (status != Status::ok) { return status; }
      if (phase_ == Phase::last_undistorting) {
        phase_ = Phase::idle;
        return Status::ok;
      }
      matcher_.begin(field_, {undistorter_.result().points,
                              anchor_.window_T_base * to_f32(undistorter_.result().odom_T_base),
                              {}});
      phase_ = Phase::matching;
      return Status::not_ready;
    case Phase::matching:
      if (!matcher_.step()) { return Status::not_ready; }
      conclude_round();
      if (phase_ == Phase::idle) { return Status::ok; }
      status = start_round(phase_);
      return status == Status::ok ? Status::not_ready : status;
  }
  return status;
}

/// Leaves `phase_` idle when the points at hand are the answer, otherwise at what is to be done.
void IteratedUndistortionCore::conclude_round() {
  ++report_.rounds;
  report_.match = matcher_.report();
  const Pose2f anchor_T_middle = between(anchor_.window_T_base, report_.match.pose);
  const Pose2f correction = to_f32(between(anchor_T_imu_middle_, to_f64(anchor_T_middle)));
  if (!is_usable(report_.match.outcome) ||
      !within(correction, config_.max_correction_m, config_.max_correction_rad)) {
    report_.believed = false;
    const bool has_imu_points = report_.rounds == 1;
    report_.correction = {};
    phase_ = has_imu_points ? Phase::idle : Phase::last_undistorting;
    return;
  }
  const Pose2f change = between(report_.correction, correction);
  report_.converged = within(change, config_.converged_m, config_.converged_rad);
  if (report_.converged || report_.rounds >= config_.max_rounds) {
    phase_ = Phase::idle;
    return;
  }
  report_.correction = correction;
  phase_ = Phase::undistorting;
}

}  // namespace picolo::inline v0
