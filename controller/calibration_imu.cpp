// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// How the IMU is turned on its vehicle: what it feels against what the wheels do.

#include "picolo/controller/calibration_routine.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

/// Sums what is felt; a window is used when the next one is full, so that the wheels have caught
/// up.
void CalibrationRoutine::feel(double stamp_s, const ImuSample& sample) {
  constexpr double kWindow_s = 0.25;
  if (phase_ != CalibrationPhase::collecting || !(report_.drive.track_m > 0.0)) {
    felt_ = {};
    felt_before_ = {};
    felt_due_ = {};
    return;
  }
  if (felt_.samples == 0.0) { felt_.begin_s = stamp_s; }
  felt_.end_s = stamp_s;
  felt_.x_mps2 += static_cast<double>(sample.acceleration_mps2[0]);
  felt_.y_mps2 += static_cast<double>(sample.acceleration_mps2[1]);
  felt_.samples += 1.0;
  if (felt_.end_s - felt_.begin_s < kWindow_s) { return; }
  felt_due_ = felt_before_;
  felt_before_ = felt_;
  felt_ = {};
}

bool CalibrationRoutine::speed_at(double stamp_s, BaseSpeed& speed) const {
  constexpr double kHalf_s = 0.04;
  WheelAngles a;
  WheelAngles b;
  const TimeOffsetCore& wheels = gyro_clock_.core();
  if (!is_ok(wheels.wheels_at(stamp_s - kHalf_s, a)) ||
      !is_ok(wheels.wheels_at(stamp_s + kHalf_s, b))) {
    return false;
  }
  const DriveParameters& d = report_.drive;
  const double left_mps = d.radius_left_m * (b.left_rad - a.left_rad) / (2.0 * kHalf_s);
  const double right_mps = d.radius_right_m * (b.right_rad - a.right_rad) / (2.0 * kHalf_s);
  speed = {0.5 * (left_mps + right_mps), (right_mps - left_mps) / d.track_m};
  return true;
}

/// A slice; false when no window waits.
bool CalibrationRoutine::use_felt() {
  const FeltWindow w = felt_due_;
  if (w.samples == 0.0) { return false; }
  felt_due_ = {};
  const double age_s = gyro_offset_report_.offset_s.value;
  BaseSpeed begin;
  BaseSpeed middle;
  BaseSpeed end;
  if (!speed_at(w.begin_s - age_s, begin) ||
      !speed_at(0.5 * (w.begin_s + w.end_s) - age_s, middle) || !speed_at(w.end_s - age_s, end)) {
    return true;
  }
  const double length_s = w.end_s - w.begin_s;
  const auto simpson = [](double a, double b, double c) { return (a + 4.0 * b + c) / 6.0; };
  static_cast<void>(mount_.add({.felt_x_mps2 = w.x_mps2 / w.samples,
                                .felt_y_mps2 = w.y_mps2 / w.samples,
                                .forward_mps2 = (end.forward_mps - begin.forward_mps) / length_s,
                                .leftward_mps2 = simpson(begin.forward_mps * begin.omega_radps,
                                                         middle.forward_mps * middle.omega_radps,
                                                         end.forward_mps * end.omega_radps),
                                .alpha_radps2 = (end.omega_radps - begin.omega_radps) / length_s,
                                .omega2_radps2 = simpson(begin.omega_radps * begin.omega_radps,
                                                         middle.omega_radps * middle.omega_radps,
                                                         end.omega_radps * end.omega_radps)}));
  return true;
}

}  // namespace picolo::inline v0
