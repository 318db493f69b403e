// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/linear_calibration.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

Status LinearCalibration::add(const MotionPair& pair) {
  const double o[3] = {pair.odometry.x_m, pair.odometry.y_m, pair.odometry.theta_rad};
  const double s[3] = {pair.scan.x_m, pair.scan.y_m, pair.scan.theta_rad};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_finite(o[k]) || !is_finite(s[k])) { return Status::invalid_argument; }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 9> row{};
    for (std::size_t j = 0; j < 3; ++j) { row[3 * k + j] = o[j]; }
    const Status status = system_.add(row, s[k]);
    if (!is_ok(status)) { return status; }
    column_squares_[k] += o[k] * o[k];
    scan_squares_[k] += s[k] * s[k];
  }
  before_squares_ += (o[0] - s[0]) * (o[0] - s[0]) + (o[1] - s[1]) * (o[1] - s[1]);
  ++samples_;
  return Status::ok;
}

Status LinearCalibration::solve(LinearReport& report, bool keep_unobserved) const {
  report = LinearReport{};
  report.samples = samples_;
  if (samples_ < 10) {
    report.refusal = {RefusalReason::too_little_data, Parameter::linear_correction};
    return Status::degenerate;
  }
  const double n = static_cast<double>(samples_);
  const double forward = square_root(column_squares_[0] / n);
  StreamingLeastSquares<9> system;
  if (!is_ok(system.core().merge(system_.core()))) { return Status::degenerate; }
  // What odometry never shows stays as it is: a tight row for the identity's entry.
  for (std::size_t j = 0; keep_unobserved && j < 3; ++j) {
    if (column_squares_[j] > 1e-8 * n * forward * forward) { continue; }
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 9> row{};
      row[3 * k + j] = forward > 0.0 ? forward : 1.0;
      if (!is_ok(system.add(row, k == j ? row[3 * k + j] : 0.0))) { return Status::degenerate; }
    }
  }
  report.condition = system.core().observability().condition;
  std::array<double, 9> x{};
  if (!is_ok(system.solve(x)) || !is_ok(system.covariance(report.covariance)) ||
      report.condition > 1e10) {
    const bool turned = column_squares_[2] > 1e-8 * n;
    report.refusal = {forward > 0.0
                          ? (turned ? RefusalReason::constant_arc : RefusalReason::straight_only)
                          : RefusalReason::standing_still,
                      Parameter::linear_correction};
    return Status::degenerate;
  }
  report.correction.elements = x;
  const double noise = n > 3.0 ? system.core().residual_squares() / (3.0 * n - 9.0) : 0.0;
  for (double& c : report.covariance) { c *= noise; }
  for (std::size_t i = 0; i < 9; ++i) {
    report.deviation.elements[i] = square_root(report.covariance[10 * i]);
  }
  report.rms_before_m = square_root(before_squares_ / n);
  report.rms_after_m = square_root(system.core().residual_squares() / n);
  return Status::ok;
}

}  // namespace picolo::inline v0
