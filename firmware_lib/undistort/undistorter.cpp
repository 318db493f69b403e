// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/undistort/undistorter.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kStampAgreement_s = 1e-3F;  // a stamp is whole microseconds, an offset a float

bool offsets_agree(const Sweep& sweep) {
  const float duration_s = to_seconds(sweep.last_stamp - sweep.stamp);
  const float last_s = sweep.returns.back().since_sweep_start_s;
  return sweep.returns.front().since_sweep_start_s >= 0.0F &&
         last_s >= duration_s - kStampAgreement_s && last_s <= duration_s + kStampAgreement_s;
}

}  // namespace

Status UndistorterCore::begin(const UndistortConfig& config, const Sweep& sweep) {
  busy_ = false;
  if (!config.valid() || sweep.returns.empty() || sweep.last_stamp < sweep.stamp ||
      !offsets_agree(sweep)) {
    return Status::invalid_argument;
  }
  if (sweep.returns.size() > x_m_.size()) { return Status::full; }
  config_ = config;
  sweep_ = sweep;
  result_ = {};
  result_.sequence = sweep.sequence;
  next_ = 0;
  points_ = 0;
  covered_ = false;
  busy_ = true;
  return Status::ok;
}

Status UndistorterCore::cover(const PoseBufferCore& poses) {
  Timestamp reference = sweep_.last_stamp;
  if (config_.reference == SweepReference::first_return) { reference = sweep_.stamp; }
  if (config_.reference == SweepReference::stamp) { reference = config_.reference_stamp; }

  const Result<Pose2d> at_start = poses.at(sweep_.stamp);
  const Result<Pose2d> at_end = poses.at(sweep_.last_stamp);
  const Result<Pose2d> at_reference = poses.at(reference);
  for (const Status status : {at_start.status(), at_end.status(), at_reference.status()}) {
    if (status == Status::out_of_range) { return status; }
  }
  for (const Status status : {at_start.status(), at_end.status(), at_reference.status()}) {
    if (status != Status::ok) { return status; }
  }

  const Pose2d base_T_lidar = to_f64(config_.base_T_lidar);
  result_.reference = reference;
  result_.odom_T_base = *at_reference;
  reference_T_odom_ =
      inverse(config_.frame == SweepFrame::base ? *at_reference : *at_reference * base_T_lidar);
  const Pose2f first = to_f32(reference_T_odom_ * *at_start * base_T_lidar);
  const Pose2f last = to_f32(reference_T_odom_ * *at_end * base_T_lidar);
  result_.lidar_at_first_m = {first.x_m, first.y_m};
  result_.lidar_at_last_m = {last.x_m, last.y_m};
  segment_end_ = sweep_.stamp;
  segment_to_ = first;
  covered_ = true;
  return advance_segment(poses);
}

Status UndistorterCore::advance_segment(const PoseBufferCore& poses) {
  segment_start_ = segment_end_;
  segment_from_ = segment_to_;
  segment_end_ = std::min(segment_start_ + config_.max_segment, sweep_.last_stamp);
  const Result<Pose2d> odom_T_base = poses.at(segment_end_);
  if (!odom_T_base) { return odom_T_base.status(); }
  segment_to_ = to_f32(reference_T_odom_ * *odom_T_base * to_f64(config_.base_T_lidar));
  segment_turn_rad_ = wrap_angle(segment_to_.theta_rad - segment_from_.theta_rad);
  segment_start_s_ = to_seconds(segment_start_ - sweep_.stamp);
  segment_end_s_ = to_seconds(segment_end_ - sweep_.stamp);
  // A sweep of one return, or of returns with one stamp, has a segment without length: its start
  // pose holds.
  inverse_segment_per_s_ =
      segment_end_ > segment_start_ ? 1.0F / (segment_end_s_ - segment_start_s_) : 0.0F;
  return Status::ok;
}

void UndistorterCore::place(const RangeReturn& beam) {
  const float elapsed_s = beam.since_sweep_start_s - segment_start_s_;
  const float share = std::clamp(elapsed_s * inverse_segment_per_s_, 0.0F, 1.0F);
  const SinCos<float> direction =
      sin_cos(segment_from_.theta_rad + share * segment_turn_rad_ + beam.bearing_rad);
  x_m_[points_] = segment_from_.x_m + share * (segment_to_.x_m - segment_from_.x_m) +
                  beam.range_m * direction.cosine;
  y_m_[points_] = segment_from_.y_m + share * (segment_to_.y_m - segment_from_.y_m) +
                  beam.range_m * direction.sine;
  ++points_;
}

Status UndistorterCore::step(const PoseBufferCore& poses, std::size_t max_returns) {
  if (!busy_) { return Status::invalid_argument; }
  if (!covered_) {
    const Status status = cover(poses);
    if (status != Status::ok) { return status; }
  }
  const std::size_t end = std::min(sweep_.returns.size(), next_ + max_returns);
  for (; next_ < end; ++next_) {
    const RangeReturn& beam = sweep_.returns[next_];
    while (beam.since_sweep_start_s > segment_end_s_ && segment_end_ < sweep_.last_stamp) {
      const Status status = advance_segment(poses);
      if (status != Status::ok) {
        busy_ = false;
        return Status::out_of_range;
      }
    }
    if (config_.limits.contains(beam.range_m) && is_finite(beam.bearing_rad)) {
      place(beam);
    } else {
      ++result_.invalid_returns;
    }
  }
  if (next_ < sweep_.returns.size()) { return Status::not_ready; }
  result_.points = {x_m_.first(points_), y_m_.first(points_)};
  busy_ = false;
  return Status::ok;
}

}  // namespace picolo::inline v0
