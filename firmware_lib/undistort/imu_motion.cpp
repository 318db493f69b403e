// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/undistort/imu_motion.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

void ImuMotion::set_velocity(float x_mps, float y_mps) {
  velocity_x_mps_ = static_cast<double>(x_mps);
  velocity_y_mps_ = static_cast<double>(y_mps);
}

Status ImuMotion::add(const ImuSample& sample, PoseBufferCore& poses) {
  const float raw_radps = sample.rate_radps[2];
  if (sample.saturated || !is_finite(raw_radps)) { return Status::invalid_argument; }
  const double rate_radps = static_cast<double>(config_.gyro_sign * raw_radps - bias_radps_);
  if (started_ && sample.stamp <= pose_.stamp) { return Status::out_of_range; }

  if (!started_ || sample.stamp - pose_.stamp > config_.max_gap) {
    gaps_ += started_ ? 1U : 0U;
    poses.clear();
  } else {
    const double interval_s = to_seconds_f64(sample.stamp - pose_.stamp);
    const double turn_rad = 0.5 * interval_s * (last_rate_radps_ + rate_radps);
    double x_m = interval_s * velocity_x_mps_;
    double y_m = interval_s * velocity_y_mps_;
    const float ax = sample.acceleration_mps2[0];
    const float ay = sample.acceleration_mps2[1];
    if (config_.use_accelerometer && is_finite(ax) && is_finite(ay)) {
      // In axes that turn with base: dv/dt = a - omega x v.
      const double x_mps2 = static_cast<double>(ax) + rate_radps * velocity_y_mps_;
      const double y_mps2 = static_cast<double>(ay) - rate_radps * velocity_x_mps_;
      x_m += 0.5 * interval_s * interval_s * static_cast<double>(ax);
      y_m += 0.5 * interval_s * interval_s * static_cast<double>(ay);
      velocity_x_mps_ += interval_s * x_mps2;
      velocity_y_mps_ += interval_s * y_mps2;
    }
    pose_.odom_T_base = pose_.odom_T_base * exp_se2(Tangent2<double>{x_m, y_m, turn_rad});
  }
  started_ = true;
  last_rate_radps_ = rate_radps;
  pose_.stamp = sample.stamp;
  return poses.push(pose_);
}

}  // namespace picolo::inline v0
