// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the wheel models share: what an encoder counts on a metre, and how an increment changes
/// with the path it is the exponential of.
#pragma once

#include <cstddef>
#include <numbers>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/matrix3.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/odometry/wheel_odometry.hpp"

namespace picolo::inline v0 {

[[nodiscard]] inline double rolled_counts_per_m(double counts_per_revolution, double radius_m) {
  return counts_per_revolution / (2.0 * std::numbers::pi * radius_m);
}

/// d(x, y, theta of exp_se2(path)) / d(path).
[[nodiscard]] inline Matrix3d plain_jacobian(const Tangent2<double>& path) {
  // exp(path + d) = exp(path) exp(J d): J is of the frame at the end, the rows x and y are turned
  // into that of the begin.
  const Matrix3d at_end = right_jacobian(path);
  const SinCos<double> turn = sin_cos(path.theta_rad);
  const Matrix3d begin_R_end{
      {turn.cosine, -turn.sine, 0.0, turn.sine, turn.cosine, 0.0, 0.0, 0.0, 1.0}};
  return product(begin_R_end, at_end);
}

/// The column of an encoder by which a radian changes the path by `per_rad`.
inline void set_column(WheelJacobian& jacobian, std::size_t wheel, const Matrix3d& slope,
                       const Tangent2<double>& per_rad) {
  for (std::size_t row = 0; row < 3; ++row) {
    jacobian.d[row][wheel] = slope(row, 0) * per_rad.x_m + slope(row, 1) * per_rad.y_m +
                             slope(row, 2) * per_rad.theta_rad;
  }
}

}  // namespace picolo::inline v0
