// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/dead_reckoning.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

// Stamps taken where frames are read come in bunches: a way of a whole period within a microsecond
// is no speed, and what is extrapolated by it lies metres away.
constexpr Duration kShortestForSpeed = 1ms;

}  // namespace

DeadReckoning::DeadReckoning(const DeadReckoningConfig& config) : config_(config) {}

void DeadReckoning::add_standing(Timestamp stamp, double rate_radps) {
  const auto limit = static_cast<double>(config_.max_bias_radps);
  if (rate_radps > limit || rate_radps < -limit) { return; }
  if (block_.samples == 0) { block_since_ = stamp; }
  if (stamp - block_since_ >= config_.standstill_block) {
    if (last_block_.samples > 0) {
      const int samples = last_block_.samples;
      bias_count_ = std::min(bias_count_ + samples, config_.bias_samples);
      bias_radps_ += (last_block_.sum_radps - static_cast<double>(samples) * bias_radps_) /
                     static_cast<double>(std::max(bias_count_, samples));
    }
    last_block_ = block_;
    block_ = {};
    block_since_ = stamp;
  }
  block_.sum_radps += rate_radps;
  ++block_.samples;
}

void DeadReckoning::correct_bias(float turned_further_rad) {
  const float limit = config_.max_bias_radps;
  const float share_radps = turned_further_rad / to_seconds(config_.bias_follows);
  bias_radps_ = static_cast<double>(std::clamp(gyro_bias_radps() - share_radps, -limit, limit));
}

void DeadReckoning::add(const ImuSample& sample) {
  if (sample.saturated || (held_ > 0 && sample.stamp <= newest().stamp)) {
    ++counters_.gyro_rejected;
    return;
  }
  const double raw_radps =
      static_cast<double>(config_.gyro_sign * config_.gyro_scale * sample.rate_radps[2]);
  if (!standing_ || bias_held_) {
    block_ = {};
    last_block_ = {};
  } else if (sample.stamp - standing_since_ >= config_.standstill) {
    add_standing(sample.stamp, raw_radps);
  }
  GyroAngle next{.stamp = sample.stamp, .rate_radps = raw_radps - bias_radps_};
  if (held_ > 0) {
    const double interval_s = to_seconds_f64(sample.stamp - newest().stamp);
    next.angle_rad =
        newest().angle_rad + interval_s * (newest().rate_radps + next.rate_radps) / 2.0;
  }
  angles_[next_] = next;
  next_ = (next_ + 1) % kAngles;
  held_ = std::min(held_ + 1, kAngles);
}

Result<double> DeadReckoning::gyro_angle_at(Timestamp stamp) const {
  if (held_ == 0) { return Status::not_ready; }
  if (stamp > newest().stamp) {
    if (stamp - newest().stamp > config_.gyro_hold) { return Status::not_ready; }
    return newest().angle_rad + to_seconds_f64(stamp - newest().stamp) * newest().rate_radps;
  }
  for (std::size_t back = 1; back < held_; ++back) {
    const GyroAngle& before = angles_[(next_ + 2 * kAngles - 1 - back) % kAngles];
    const GyroAngle& after = angles_[(next_ + 2 * kAngles - back) % kAngles];
    if (before.stamp > stamp) { continue; }
    const double share =
        to_seconds_f64(stamp - before.stamp) / to_seconds_f64(after.stamp - before.stamp);
    return before.angle_rad + share * (after.angle_rad - before.angle_rad);
  }
  return Status::out_of_range;
}

void DeadReckoning::add(const WheelIncrement& increment) {
  if (!increment.standing) { standing_ = false; }
  if (increment.standing && !standing_) {
    standing_ = true;
    standing_since_ = increment.from;
  }

  Pose2d motion = increment.from_T_to;
  const Result<double> angle =
      config_.use_gyro ? gyro_angle_at(increment.to) : Result<double>{Status::not_ready};
  if (angle && used_gyro_ && used_stamp_ == increment.from) {
    // Same arc length, the gyro's turn: the chord of the wheels' arc is kept, its direction follows
    // half of the turn.
    const Tangent2<double> wheels = log_se2(increment.from_T_to);
    motion = exp_se2(Tangent2<double>{wheels.x_m, wheels.y_m, *angle - used_angle_rad_});
    ++counters_.with_gyro;
  }
  used_gyro_ = static_cast<bool>(angle);
  used_angle_rad_ = angle.value_or(0.0);
  used_stamp_ = increment.to;

  pose_ = {increment.to, pose_.odom_T_base * motion};
  ++counters_.increments;
  if (increment.to - increment.from < kShortestForSpeed) { return; }
  const double interval_s = to_seconds_f64(increment.to - increment.from);
  const Tangent2<double> velocity = log_se2(motion);
  twist_ = {static_cast<float>(velocity.x_m / interval_s),
            static_cast<float>(velocity.y_m / interval_s),
            static_cast<float>(velocity.theta_rad / interval_s)};
}

}  // namespace picolo::inline v0
