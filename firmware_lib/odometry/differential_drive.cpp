// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/differential_drive.hpp"

#include <numbers>

#include "path_jacobian.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

static_assert(DifferentiableWheelOdometry<DifferentialDrive>);

namespace {

Pose2d corrected(const Matrix3d& x, const Pose2d& o) {
  return {x(0, 0) * o.x_m + x(0, 1) * o.y_m + x(0, 2) * o.theta_rad,
          x(1, 0) * o.x_m + x(1, 1) * o.y_m + x(1, 2) * o.theta_rad,
          x(2, 0) * o.x_m + x(2, 1) * o.y_m + x(2, 2) * o.theta_rad};
}

}  // namespace

DifferentialDrive::DifferentialDrive(const DifferentialDriveConfig& config)
    : config_(config), corrected_(!(config.correction == Matrix3d::identity())) {}

Result<WheelIncrement> DifferentialDrive::update(const WheelTicks& ticks) {
  if (!has_last_ || ticks.restarted) {
    last_ = ticks;
    has_last_ = true;
    return Status::not_ready;
  }
  if (ticks.stamp <= last_.stamp) { return Status::out_of_range; }
  const std::int64_t left_counts = ticks.ticks[0] - last_.ticks[0];
  const std::int64_t right_counts = ticks.ticks[1] - last_.ticks[1];
  const double radians_per_count = 2.0 * std::numbers::pi / config_.counts_per_revolution;
  const double left_m =
      static_cast<double>(left_counts) * (radians_per_count * config_.left_radius_m);
  const double right_m =
      static_cast<double>(right_counts) * (radians_per_count * config_.right_radius_m);

  WheelIncrement increment{.from = last_.stamp, .to = ticks.stamp};
  path_ = {(left_m + right_m) / 2.0, 0.0, (right_m - left_m) / config_.track_m};
  increment.from_T_to = exp_se2(path_);
  if (corrected_) { increment.from_T_to = corrected(config_.correction, increment.from_T_to); }
  increment.standing = left_counts == 0 && right_counts == 0;
  last_ = ticks;
  return increment;
}

WheelJacobian DifferentialDrive::jacobian() const {
  Matrix3d slope = plain_jacobian(path_);
  if (corrected_) { slope = product(config_.correction, slope); }
  WheelJacobian jacobian;
  set_column(jacobian, 0, slope,
             {0.5 * config_.left_radius_m, 0.0, -config_.left_radius_m / config_.track_m});
  set_column(jacobian, 1, slope,
             {0.5 * config_.right_radius_m, 0.0, config_.right_radius_m / config_.track_m});
  return jacobian;
}

EncoderScale DifferentialDrive::encoder_scale() const {
  return {{rolled_counts_per_m(config_.counts_per_revolution, config_.left_radius_m),
           rolled_counts_per_m(config_.counts_per_revolution, config_.right_radius_m)}};
}

}  // namespace picolo::inline v0
