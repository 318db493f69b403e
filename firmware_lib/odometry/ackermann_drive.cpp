// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/ackermann_drive.hpp"

#include <numbers>

#include "path_jacobian.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

static_assert(DifferentiableWheelOdometry<AckermannDrive>);

Result<WheelIncrement> AckermannDrive::update(const WheelTicks& ticks) {
  if (!has_last_ || ticks.restarted) {
    last_ = ticks;
    has_last_ = true;
    return Status::not_ready;
  }
  if (ticks.stamp <= last_.stamp) { return Status::out_of_range; }
  const WheelTicks before = last_;
  last_ = ticks;
  const std::int64_t counts = ticks.ticks[0] - before.ticks[0];
  const double path_m =
      static_cast<double>(counts) *
      (2.0 * std::numbers::pi * config_.wheel_radius_m / config_.counts_per_revolution);
  const double mean_counts =
      (static_cast<double>(before.ticks[1]) + static_cast<double>(ticks.ticks[1])) / 2.0;
  const double steering_rad = (mean_counts - config_.steering_zero_counts) *
                              (2.0 * std::numbers::pi / config_.steering_counts_per_turn);
  if (steering_rad > config_.max_steering_rad || steering_rad < -config_.max_steering_rad) {
    return Status::out_of_range;
  }
  const Steered at = steered(steering_rad);
  path_m_ = path_m;
  steering_rad_ = steering_rad;
  WheelIncrement increment{.from = before.stamp, .to = ticks.stamp};
  increment.from_T_to =
      exp_se2(Tangent2<double>{path_m * at.per_m.x_m, 0.0, path_m * at.per_m.theta_rad});
  increment.standing = counts == 0;
  return increment;
}

AckermannDrive::Steered AckermannDrive::steered(double steering_rad) const {
  const SinCos<double> steering = sin_cos(steering_rad);
  const double wheelbase_m = config_.wheelbase_m;
  if (config_.driven == DrivenAxle::steered) {
    return {{steering.cosine, 0.0, steering.sine / wheelbase_m},
            {-steering.sine, 0.0, steering.cosine / wheelbase_m}};
  }
  return {{1.0, 0.0, steering.sine / (steering.cosine * wheelbase_m)},
          {0.0, 0.0, 1.0 / (steering.cosine * steering.cosine * wheelbase_m)}};
}

WheelJacobian AckermannDrive::jacobian() const {
  const Steered at = steered(steering_rad_);
  const Matrix3d slope =
      plain_jacobian({path_m_ * at.per_m.x_m, 0.0, path_m_ * at.per_m.theta_rad});
  const double radius_m = config_.wheel_radius_m;
  WheelJacobian jacobian;
  set_column(jacobian, 0, slope, {radius_m * at.per_m.x_m, 0.0, radius_m * at.per_m.theta_rad});
  set_column(jacobian, 1, slope,
             {0.5 * path_m_ * at.per_m_rad.x_m, 0.0, 0.5 * path_m_ * at.per_m_rad.theta_rad});
  return jacobian;
}

EncoderScale AckermannDrive::encoder_scale() const {
  return {{rolled_counts_per_m(config_.counts_per_revolution, config_.wheel_radius_m)}};
}

}  // namespace picolo::inline v0
