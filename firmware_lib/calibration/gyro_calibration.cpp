// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/gyro_calibration.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint64_t kBeforeGate = 20;

}  // namespace

void GyroCalibration::add_standing(double rate_radps) {
  if (!is_finite(rate_radps)) { return; }
  ++standing_;
  const double before = rate_radps - mean_;
  mean_ += before / static_cast<double>(standing_);
  squares_ += before * (rate_radps - mean_);
}

bool GyroCalibration::passes(double gyro_rad, double duration_s, double lidar_rad) {
  std::array<double, 2> x{};
  if (turns_.core().rows() < kBeforeGate || !is_ok(turns_.solve(x))) { return true; }
  if (median_rad_ == 0.0) {
    const auto rows = static_cast<double>(turns_.core().rows());
    median_rad_ = square_root(std::max(1e-12, turns_.core().residual_squares() / rows));
  }
  const double error = magnitude(lidar_rad - (x[0] * gyro_rad + x[1] * duration_s));
  const bool good = error <= 6.0 * median_rad_;
  median_rad_ *= error > median_rad_ ? 1.04 : 1.0 / 1.04;
  return good;
}

Status GyroCalibration::add_turn(double gyro_rad, double duration_s, double lidar_rad) {
  if (!is_finite(gyro_rad) || !is_finite(duration_s) || !is_finite(lidar_rad) ||
      !(duration_s > 0.0)) {
    return Status::invalid_argument;
  }
  if (!passes(gyro_rad, duration_s, lidar_rad)) {
    ++rejected_;
    return Status::ok;
  }
  turned_rad_ += magnitude(lidar_rad);
  return turns_.add({gyro_rad, duration_s}, lidar_rad);
}

Status GyroCalibration::solve(GyroReport& report) const {
  report = GyroReport{};
  report.standing = standing_;
  report.turns = turns_.core().rows();
  report.rejected = rejected_;
  const auto standing = static_cast<double>(standing_);
  if (standing_ > 1) {
    report.bias_radps = {mean_, square_root(squares_ / (standing - 1.0) / standing)};
  }
  if (standing_ < config_.min_standing || !(report.bias_radps.std <= config_.max_bias_std_radps)) {
    report.bias_refusal = {RefusalReason::too_little_data, Parameter::gyro_bias};
  } else if (magnitude(mean_) > config_.max_bias_radps) {
    report.bias_refusal = {RefusalReason::inconsistent, Parameter::gyro_bias};
  }
  std::array<double, 2> x{};
  std::array<double, 4> covariance{};
  const auto rows = static_cast<double>(report.turns);
  if (report.turns < config_.min_turns) {
    report.scale_refusal = {RefusalReason::too_little_data, Parameter::gyro_scale};
  } else if (turned_rad_ < config_.min_turned_rad || !is_ok(turns_.solve(x)) ||
             !is_ok(turns_.covariance(covariance))) {
    report.scale_refusal = {RefusalReason::straight_only, Parameter::gyro_scale};
  } else {
    report.noise_rad = square_root(turns_.core().residual_squares() / (rows - 2.0));
    report.scale = {x[0], report.noise_rad * square_root(covariance[0])};
    report.drift_radps = x[1] + x[0] * mean_;
    if (!(report.scale.std <= config_.max_scale_std)) {
      report.scale_refusal = {RefusalReason::too_little_data, Parameter::gyro_scale};
    }
  }
  return report.bias_refusal || report.scale_refusal ? Status::degenerate : Status::ok;
}

void GyroCalibration::forget_turns() {
  turns_.reset();
  turned_rad_ = 0.0;
  median_rad_ = 0.0;
  rejected_ = 0;
}

void GyroCalibration::reset() {
  forget_turns();
  standing_ = 0;
  mean_ = 0.0;
  squares_ = 0.0;
}

}  // namespace picolo::inline v0
