// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "joint_system.hpp"

#include "arc.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/solve/normal_least_squares.hpp"

namespace picolo::inline v0 {
namespace {

struct Direction {
  double cosine;
  double sine;
};

/// Unit eigenvector of the smaller eigenvalue of [a b; b c].
Direction smallest_eigenvector(double a, double b, double c) {
  const double half = 0.5 * (a - c);
  const double root = hypotenuse(half, b);
  // (A - lambda I) has rows (half + root, b) and (b, root - half); the eigenvector is orthogonal to
  // the longer one.
  const bool first = half > 0.0;
  const double x = first ? -b : root - half;
  const double y = first ? half + root : -b;
  const double length = hypotenuse(x, y);
  if (!(length > 0.0)) { return {1.0, 0.0}; }
  return {x / length, y / length};
}

}  // namespace

void add_joint_rows(JointMatrix& m, const RotationGain& gain, const MotionSample& sample) {
  const double left = sample.duration_s * sample.left_radps;
  const double right = sample.duration_s * sample.right_radps;
  const double turn = gain.j21 * left + gain.j22 * right;
  const double length = 0.5 * (gain.j22 * right - gain.j21 * left);
  const Arc arc = arc_of(turn);
  const SinCos<double> sc = sin_cos(turn);
  const double sx = sample.lidar_motion.x_m;
  const double sy = sample.lidar_motion.y_m;
  const std::array<double, 5> x{-length * arc.along, 1.0 - sc.cosine, sc.sine, sx, -sy};
  const std::array<double, 5> y{-length * arc.across, -sc.sine, 1.0 - sc.cosine, sy, sx};
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) { m[5 * i + j] += x[i] * x[j] + y[i] * y[j]; }
  }
}

Status solve_joint(const JointMatrix& m, const RotationGain& gain, DriveParameters& drive) {
  std::array<double, 9> upper{};
  std::array<double, 3> cosine_column{};
  std::array<double, 3> sine_column{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) { upper[3 * i + j] = m[5 * i + j]; }
    cosine_column[i] = m[5 * i + 3];
    sine_column[i] = m[5 * i + 4];
  }
  std::array<double, 3> by_cosine{};
  std::array<double, 3> by_sine{};
  if (!is_ok(solve_symmetric(upper, cosine_column, by_cosine)) ||
      !is_ok(solve_symmetric(upper, sine_column, by_sine))) {
    return Status::degenerate;
  }
  double cc = m[18];
  double cs = m[19];
  double ss = m[24];
  for (std::size_t i = 0; i < 3; ++i) {
    cc -= cosine_column[i] * by_cosine[i];
    cs -= cosine_column[i] * by_sine[i];
    ss -= sine_column[i] * by_sine[i];
  }
  Direction yaw = smallest_eigenvector(cc, cs, ss);
  std::array<double, 3> q{};
  for (std::size_t i = 0; i < 3; ++i) {
    q[i] = -(by_cosine[i] * yaw.cosine + by_sine[i] * yaw.sine);
  }
  if (q[0] == 0.0) { return Status::degenerate; }
  if (q[0] < 0.0) {
    yaw = {-yaw.cosine, -yaw.sine};
    for (double& value : q) { value = -value; }
  }
  drive.track_m = q[0];
  drive.radius_left_m = -gain.j21 * q[0];
  drive.radius_right_m = gain.j22 * q[0];
  drive.base_T_lidar = {q[1], q[2], arc_tangent2(yaw.sine, yaw.cosine)};
  return Status::ok;
}

}  // namespace picolo::inline v0
