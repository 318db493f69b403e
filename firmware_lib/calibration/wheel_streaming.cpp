// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/wheel_streaming.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "quadratic.hpp"
#include "wheel_solution.hpp"

namespace picolo::inline v0 {

void WheelStreaming::add(const WheelStretch& stretch, const ScanMotion& scan) {
  const double left = stretch.duration_s * stretch.left_radps;
  const double right = stretch.duration_s * stretch.right_radps;
  left_rad_ += left;
  right_rad_ += right;
  const Quadratic length =
      linear_form(0.5 * (reference_.j22 * right - reference_.j21 * left), -0.5 * left, 0.5 * right);
  const SinCos<double> sc = sin_cos(heading_[0]);
  add_to(x_, length * chain(heading_, sc.cosine, -sc.sine, -sc.cosine));
  add_to(y_, length * chain(heading_, sc.sine, sc.cosine, -sc.sine));
  add_to(heading_, linear_form(reference_.j21 * left + reference_.j22 * right, left, right));
  if (stretch.closes) { close(scan); }
}

void WheelStreaming::close(const ScanMotion& scan) {
  if (is_ok(rotation_.add({left_rad_, right_rad_}, scan.motion.theta_rad))) {
    check_.add({1.0, left_rad_, right_rad_, scan.motion});
    add_to(cc_, x_ * x_ + y_ * y_);
    add_to(cs_, scan.motion.x_m * x_ + scan.motion.y_m * y_);
    ss_ += scan.motion.x_m * scan.motion.x_m + scan.motion.y_m * scan.motion.y_m;
  }
  left_rad_ = 0.0;
  right_rad_ = 0.0;
  heading_ = {};
  x_ = {};
  y_ = {};
  // Follow the gains once they are known, so that later intervals are expanded where they matter.
  std::array<double, 2> j{};
  if (rotation_.core().rows() < 50 || check_.arc_spread() < 1e-3 || !is_ok(rotation_.solve(j))) {
    return;
  }
  const double a = j[0] - reference_.j21;
  const double b = j[1] - reference_.j22;
  if (hypotenuse(a, b) < 0.001 * hypotenuse(j[0], j[1])) { return; }
  cc_ = shifted(cc_, a, b);
  cs_ = shifted(cs_, a, b);
  reference_ = {j[0], j[1]};
}

Status WheelStreaming::solve(WheelReport& report) const {
  report = WheelReport{};
  std::array<double, 2> j{};
  WheelSums sums;
  if (is_ok(rotation_.solve(j))) {
    const double a = j[0] - reference_.j21;
    const double b = j[1] - reference_.j22;
    sums = {evaluate(cc_, a, b), evaluate(cs_, a, b), ss_};
  }
  return solve_wheels(rotation_, sums, check_, config_, report);
}

}  // namespace picolo::inline v0
