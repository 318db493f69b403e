// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/imu_mount.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

Status ImuMountCalibration::add(const AccelerationWindow& w) {
  if (!is_finite(w.felt_x_mps2) || !is_finite(w.felt_y_mps2) || !is_finite(w.forward_mps2) ||
      !is_finite(w.leftward_mps2) || !is_finite(w.alpha_radps2) || !is_finite(w.omega2_radps2)) {
    return Status::invalid_argument;
  }
  const double ax = w.forward_mps2;
  const double ay = w.leftward_mps2;
  const Status x =
      system_.add({ax, ay, -w.omega2_radps2, -w.alpha_radps2, 1.0, 0.0}, w.felt_x_mps2);
  const Status y =
      system_.add({ay, -ax, w.alpha_radps2, -w.omega2_radps2, 0.0, 1.0}, w.felt_y_mps2);
  if (!is_ok(x)) { return x; }
  squares_ += ax * ax + ay * ay;
  ++windows_;
  return y;
}

Status ImuMountCalibration::solve(ImuMountReport& report) const {
  report = ImuMountReport{};
  report.windows = windows_;
  const auto refuse = [&](RefusalReason reason) {
    report.refusal = {reason, Parameter::gyro_yaw};
    return Status::degenerate;
  };
  if (windows_ < config_.min_windows) { return refuse(RefusalReason::too_little_data); }
  const auto count = static_cast<double>(windows_);
  const double least = config_.min_acceleration_mps2;
  std::array<double, 6> x{};
  std::array<double, 36> covariance{};
  if (squares_ < count * least * least || !is_ok(system_.solve(x)) ||
      !is_ok(system_.covariance(covariance))) {
    return refuse(RefusalReason::constant_velocity);
  }
  report.scale = hypotenuse(x[0], x[1]);
  report.tilt_x_mps2 = x[4];
  report.tilt_y_mps2 = x[5];
  report.noise_mps2 = square_root(system_.core().residual_squares() / (2.0 * count - 6.0));
  if (!(report.scale > 0.5) || !(report.scale < 2.0)) {
    return refuse(RefusalReason::inconsistent);
  }
  report.yaw_rad = {arc_tangent2(x[1], x[0]),
                    report.noise_mps2 * square_root(covariance[7]) / report.scale};
  return report.yaw_rad.std <= config_.max_yaw_std_rad ? Status::ok
                                                       : refuse(RefusalReason::too_little_data);
}

void ImuMountCalibration::reset() {
  system_.reset();
  squares_ = 0.0;
  windows_ = 0;
}

}  // namespace picolo::inline v0
