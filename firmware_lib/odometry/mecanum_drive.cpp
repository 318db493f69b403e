// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/mecanum_drive.hpp"

#include <numbers>

#include "path_jacobian.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

static_assert(DifferentiableWheelOdometry<MecanumDrive>);

namespace {

// Signs of a wheel's path in forward, leftward and turning motion: front left, front right, rear
// left, rear right.
constexpr std::array<double, kMaxWheels> kLeftward{-1.0, 1.0, 1.0, -1.0};
constexpr std::array<double, kMaxWheels> kTurning{-1.0, 1.0, -1.0, 1.0};
constexpr std::array<double, kMaxWheels> kSlip{1.0, 1.0, -1.0, -1.0};  // no motion does this

}  // namespace

Result<WheelIncrement> MecanumDrive::update(const WheelTicks& ticks) {
  if (!has_last_ || ticks.restarted) {
    last_ = ticks;
    has_last_ = true;
    return Status::not_ready;
  }
  if (ticks.stamp <= last_.stamp) { return Status::out_of_range; }
  const double radians_per_count = 2.0 * std::numbers::pi / config_.counts_per_revolution;
  const double arm_m = (config_.track_m + config_.wheelbase_m) / 2.0;
  WheelIncrement increment{.from = last_.stamp, .to = ticks.stamp, .standing = true};
  Tangent2<double> path{};
  double slip_m = 0.0;
  for (std::size_t k = 0; k < kMaxWheels; ++k) {
    const std::int64_t counts = ticks.ticks[k] - last_.ticks[k];
    increment.standing = increment.standing && counts == 0;
    const double quarter_m =
        static_cast<double>(counts) * (radians_per_count * config_.radius_m[k]) / 4.0;
    path.x_m += quarter_m;
    path.y_m += kLeftward[k] * quarter_m;
    path.theta_rad += kTurning[k] * quarter_m / arm_m;
    slip_m += kSlip[k] * quarter_m;
  }
  increment.from_T_to = exp_se2(path);
  path_ = path;
  slip_m_ = slip_m;
  last_ = ticks;
  return increment;
}

WheelJacobian MecanumDrive::jacobian() const {
  const Matrix3d slope = plain_jacobian(path_);
  const double arm_m = (config_.track_m + config_.wheelbase_m) / 2.0;
  WheelJacobian jacobian;
  for (std::size_t k = 0; k < kMaxWheels; ++k) {
    const double quarter_m = config_.radius_m[k] / 4.0;
    set_column(jacobian, k, slope,
               {quarter_m, kLeftward[k] * quarter_m, kTurning[k] * quarter_m / arm_m});
  }
  return jacobian;
}

EncoderScale MecanumDrive::encoder_scale() const {
  EncoderScale scale;
  for (std::size_t k = 0; k < kMaxWheels; ++k) {
    scale.counts_per_m[k] = rolled_counts_per_m(config_.counts_per_revolution, config_.radius_m[k]);
  }
  return scale;
}

}  // namespace picolo::inline v0
