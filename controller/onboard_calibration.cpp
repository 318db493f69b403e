// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/onboard_calibration.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kAlways = 7;  // values told with or without a gyro
constexpr std::size_t kWithGyro = 11;

}  // namespace

OnboardCalibrationConfig onboard_calibration(const ControllerConfig& config) {
  OnboardCalibrationConfig result;
  result.routine.counts_per_revolution = config.drive.counts_per_revolution;
  result.routine.use_gyro = config.dead_reckoning.use_gyro;
  result.routine.gyro_sign = static_cast<double>(config.dead_reckoning.gyro_sign);
  result.routine.known_lidar_age_s = to_seconds_f64(config.lidar_age);
  result.base_T_lidar = to_f64(config.undistort.base_T_lidar);
  return result;
}

void apply(const CalibrationRecord& record, ControllerConfig& config) {
  if (!record.calibrated) { return; }
  config.drive.left_radius_m = record.drive.radius_left_m;
  config.drive.right_radius_m = record.drive.radius_right_m;
  config.drive.track_m = record.drive.track_m;
  config.undistort.base_T_lidar = to_f32(record.drive.base_T_lidar);
  config.lidar_age = from_seconds(record.time_offset_s);
  config.dead_reckoning.gyro_scale = static_cast<float>(record.gyro_scale);
}

Status OnboardCalibrationCore::start(std::uint8_t procedure, Timestamp now) {
  now_ = now;
  if (procedure == kFinishCalibration) { return routine_.finish(); }
  if (procedure != kCalibrateAll) { return Status::invalid_argument; }
  if (!is_ok(routine_.start(now))) { return Status::not_ready; }
  scans_.reset();
  return Status::ok;
}

Status OnboardCalibrationCore::cancel(Timestamp now) {
  now_ = now;
  return routine_.cancel();
}

void OnboardCalibrationCore::add(const UndistortedSweep& sweep) {
  if (!routine_.listening()) { return; }
  scans_.offer(sweep.points, sweep.reference, sweep.odom_T_base, config_.base_T_lidar);
}

void OnboardCalibrationCore::step(Timestamp now) {
  if (!routine_.running()) { return; }
  now_ = now;
  for (std::size_t k = 0; k < config_.slices; ++k) {
    // By turns, so that neither starves the other; an idle one leaves its turn to the other.
    routine_first_ = !routine_first_;
    static_cast<void>(routine_first_ ? routine_.step(now) || scans_.step()
                                     : scans_.step() || routine_.step(now));
    ScanDisplacement seen;
    if (scans_.take(seen)) { routine_.add_scan(seen.begin, seen.end, seen.motion); }
  }
}

CalibrationProgress OnboardCalibrationCore::progress() const {
  const CalibrationHint shares = hint();
  std::uint8_t least = std::min({shares.wheels, shares.track, shares.lidar_xy, shares.lidar_yaw,
                                 shares.time_offset, shares.gyro});
  if (routine_.phase() == CalibrationPhase::done) { least = 100; }
  return {.phase = routine_.phase(),
          .procedure = kCalibrateAll,
          .percent = least,
          .refusal = routine_.refusal(),
          .samples = static_cast<std::uint32_t>(routine_.report().used),
          .elapsed = routine_.elapsed(now_)};
}

CalibrationHint OnboardCalibrationCore::hint() const {
  const auto percent = [&](Parameter parameter) { return routine_.percent(parameter); };
  CalibrationHint hint;
  hint.advice = routine_.advice();
  hint.wheels =
      std::min(percent(Parameter::wheel_radius_left), percent(Parameter::wheel_radius_right));
  hint.track = percent(Parameter::track_width);
  hint.lidar_xy = std::min(percent(Parameter::lidar_x), percent(Parameter::lidar_y));
  hint.lidar_yaw = percent(Parameter::lidar_yaw);
  hint.time_offset = percent(Parameter::time_offset);
  if (routine_.gyro_heard()) { hint.gyro = percent(Parameter::gyro_scale); }
  return hint;
}

std::size_t OnboardCalibrationCore::value_count() const {
  if (routine_.phase() != CalibrationPhase::done) { return 0; }
  return routine_.gyro_heard() ? kWithGyro : kAlways;
}

CalibrationValue OnboardCalibrationCore::value(std::size_t index) const {
  const CalibrationRecord& found = routine_.record();
  const auto& std = found.drive_std;
  switch (index) {
    case 0: return {Parameter::wheel_radius_left, {found.drive.radius_left_m, std[0]}};
    case 1: return {Parameter::wheel_radius_right, {found.drive.radius_right_m, std[1]}};
    case 2: return {Parameter::track_width, {found.drive.track_m, std[2]}};
    case 3: return {Parameter::lidar_x, {found.drive.base_T_lidar.x_m, std[3]}};
    case 4: return {Parameter::lidar_y, {found.drive.base_T_lidar.y_m, std[4]}};
    case 5: return {Parameter::lidar_yaw, {found.drive.base_T_lidar.theta_rad, std[5]}};
    case 6:
      return {Parameter::time_offset, {found.time_offset_s, routine_.offset_report().offset_s.std}};
    case 7: return {Parameter::gyro_bias, routine_.gyro_report().bias_radps};
    case 8: return {Parameter::gyro_scale, routine_.gyro_report().scale};
    case 9: return {Parameter::gyro_offset, routine_.gyro_offset_report().offset_s};
    default: return {Parameter::gyro_yaw, routine_.mount_report().yaw_rad};
  }
}

}  // namespace picolo::inline v0
