// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/wheel_batch.hpp"

#include "picolo/calibration/wheel_walk.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "wheel_solution.hpp"

namespace picolo::inline v0 {
namespace {

Status refuse(WheelReport& report, RefusalReason reason, Parameter parameter) {
  if (!report.refusal) { report.refusal = {reason, parameter}; }
  return Status::degenerate;
}

/// Pass one: theta = J21 (integral of w_L) + J22 (integral of w_R).
void gather_rotation(WheelWalk& walk, StreamingLeastSquares<2>& rotation, MotionCheck& check) {
  WheelStretch stretch;
  ScanMotion scan;
  double left = 0.0;
  double right = 0.0;
  while (walk.next(stretch, scan)) {
    left += stretch.duration_s * stretch.left_radps;
    right += stretch.duration_s * stretch.right_radps;
    if (!stretch.closes) { continue; }
    if (is_ok(rotation.add({left, right}, scan.motion.theta_rad))) {
      check.add({1.0, left, right, scan.motion});
    }
    left = 0.0;
    right = 0.0;
  }
}

/// Pass two: the path with unit track width, each step along the heading before it.
WheelSums gather_translation(WheelWalk& walk, double j21, double j22) {
  WheelSums sums;
  WheelStretch stretch;
  ScanMotion scan;
  double cx = 0.0;
  double cy = 0.0;
  double heading = 0.0;
  while (walk.next(stretch, scan)) {
    const double left = stretch.duration_s * stretch.left_radps;
    const double right = stretch.duration_s * stretch.right_radps;
    const double length = 0.5 * (j22 * right - j21 * left);
    const SinCos<double> direction = sin_cos(heading);
    cx += length * direction.cosine;
    cy += length * direction.sine;
    heading += j21 * left + j22 * right;
    if (!stretch.closes) { continue; }
    sums.cc += cx * cx + cy * cy;
    sums.cs += cx * scan.motion.x_m + cy * scan.motion.y_m;
    sums.ss += scan.motion.x_m * scan.motion.x_m + scan.motion.y_m * scan.motion.y_m;
    cx = cy = heading = 0.0;
  }
  return sums;
}

}  // namespace

Status solve_wheels(const StreamingLeastSquares<2>& rotation, const WheelSums& translation,
                    const MotionCheck& check, const WheelBatchConfig& config, WheelReport& report) {
  report.used = rotation.core().rows();
  report.condition = rotation.core().observability().condition;
  std::array<double, 2> j{};
  std::array<double, 4> cj{};
  const bool informed = check.explained_rotation() >= config.sufficient_explained;
  const Refusal missing = check.judge(config.needs);
  if (missing && !(informed && missing.parameter == Parameter::track_width)) {
    report.refusal = missing;
  }
  if (!is_ok(rotation.solve(j)) || !is_ok(rotation.covariance(cj)) || !(translation.cc > 0.0)) {
    return refuse(report, RefusalReason::numerically_singular, Parameter::track_width);
  }
  const double n = static_cast<double>(report.used);
  const double noise = n > 2.0 ? rotation.core().residual_squares() / (n - 2.0) : 0.0;
  for (double& c : cj) { c *= noise; }
  const double b = translation.cs / translation.cc;
  const double left_over = translation.ss - b * translation.cs;
  const double var_b =
      left_over > 0.0 && n > 1.0 ? left_over / (2.0 * n - 1.0) / translation.cc : 0.0;
  report.j21 = {j[0], square_root(cj[0])};
  report.j22 = {j[1], square_root(cj[3])};
  report.track_m = {b, square_root(var_b)};
  // r_L = -J21 b, r_R = J22 b; rotation and translation have independent noise.
  const double g[9] = {-b, 0.0, -j[0], 0.0, b, j[1], 0.0, 0.0, 1.0};
  const double c[9] = {cj[0], cj[1], 0.0, cj[2], cj[3], 0.0, 0.0, 0.0, var_b};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      double value = 0.0;
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t q = 0; q < 3; ++q) {
          value += g[3 * row + p] * c[3 * p + q] * g[3 * column + q];
        }
      }
      report.covariance[3 * row + column] = value;
    }
  }
  report.radius_left_m = {-j[0] * b, square_root(report.covariance[0])};
  report.radius_right_m = {j[1] * b, square_root(report.covariance[4])};
  const auto too_wide = [&](const Estimate& e) {
    return !(e.std <= config.max_relative_std * magnitude(e.value));
  };
  if (too_wide(report.j21) || too_wide(report.j22) || too_wide(report.track_m)) {
    return refuse(report, RefusalReason::too_little_data, Parameter::track_width);
  }
  return report.refusal ? Status::degenerate : Status::ok;
}

Status calibrate_wheels(SampleSource<WheelRates>& rates, SampleSource<ScanMotion>& scans,
                        const WheelBatchConfig& config, WheelReport& report) {
  report = WheelReport{};
  if (!config.valid()) { return Status::invalid_argument; }
  WheelWalk walk{rates, scans};
  StreamingLeastSquares<2> rotation;
  MotionCheck check;
  walk.rewind(config.limit);
  gather_rotation(walk, rotation, check);
  std::array<double, 2> j{};
  WheelSums translation;
  if (is_ok(rotation.solve(j))) {
    walk.rewind(config.limit);
    translation = gather_translation(walk, j[0], j[1]);
  }
  return solve_wheels(rotation, translation, check, config, report);
}

}  // namespace picolo::inline v0
