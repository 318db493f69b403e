// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// How the routine holds its answers against samples that it has not used.

#include <algorithm>

#include "picolo/controller/calibration_routine.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

void CalibrationRoutine::verify(const MotionSample& sample) {
  constexpr double kMoved_rad = 0.02;  // of a wheel
  if (sample.duration_s * (magnitude(sample.left_radps) + magnitude(sample.right_radps)) <
      2.0 * kMoved_rad) {
    return;
  }
  const Pose2d error = motion_residual(record_.drive, sample);
  const Pose2d& noise = report_.noise;
  const double x = error.x_m / noise.x_m;
  const double y = error.y_m / noise.y_m;
  const double theta = error.theta_rad / noise.theta_rad;
  ++verified_;
  if (x * x + y * y > config_.joint.gate_translation ||
      theta * theta > config_.joint.gate_rotation) {
    return;
  }
  ++within_;
  error_sum_ = {error_sum_.x_m + x, error_sum_.y_m + y, error_sum_.theta_rad + theta};
}

void CalibrationRoutine::judge_verification(Timestamp now) {
  if (verified_ < config_.verify_samples) {
    if (now - entered_ > config_.max_wait) {
      refuse({verified_ == 0 ? RefusalReason::standing_still : RefusalReason::too_little_data,
              Parameter::wheel_radius_left});
    }
    return;
  }
  const auto within = static_cast<double>(within_);
  // Mean errors in units of one sample's noise: a wrong model shows as a mean, noise averages out.
  const double limit = within > 0.0 ? 0.5 + 4.0 / square_root(within) : 0.0;
  const double x = magnitude(error_sum_.x_m) / std::max(1.0, within);
  const double y = magnitude(error_sum_.y_m) / std::max(1.0, within);
  const double theta = magnitude(error_sum_.theta_rad) / std::max(1.0, within);
  const bool enough = within >= config_.min_verified_share * static_cast<double>(verified_);
  if (enough && x <= limit && y <= limit && theta <= limit) {
    advice_ = DriveAdvice::none;
    enter(CalibrationPhase::saving, now);
    return;
  }
  Parameter worst = Parameter::track_width;
  if (x > std::max(y, theta)) { worst = Parameter::wheel_radius_left; }
  if (y > std::max(x, theta)) { worst = Parameter::lidar_yaw; }
  refuse({RefusalReason::inconsistent, worst});
}

}  // namespace picolo::inline v0
