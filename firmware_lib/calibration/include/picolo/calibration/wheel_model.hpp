// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The six parameters of a differential drive with a lidar, and what they predict the lidar sees
/// (Censi, Franchi, Marchionni, Oriolo 2013, "Simultaneous calibration of odometry and sensor
/// parameters for mobile robots", IEEE T-RO 29(2)).
#pragma once

#include <array>

#include "picolo/calibration/samples.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

/// Wheel radii, track width and base_T_lidar; base is the middle of the axle.
struct DriveParameters {
  double radius_left_m = 0.0;
  double radius_right_m = 0.0;
  double track_m = 0.0;
  Pose2d base_T_lidar{};
};

/// theta = J21 (integral of w_L) + J22 (integral of w_R): J21 = -r_L / b, J22 = r_R / b.
struct RotationGain {
  double j21 = 0.0;
  double j22 = 0.0;
};

/// Rows x, y, theta of the lidar's motion; columns r_L, r_R, b, l_x, l_y, l_theta; row-major.
using DriveJacobian = std::array<double, 18>;
/// Symmetric, row-major, ordered as the columns above.
using DriveMatrix = std::array<double, 36>;

/// last_T_now of base for wheels that keep their rates: an exact arc. Cost: one sin_cos.
[[nodiscard]] Pose2d base_motion(const DriveParameters& drive, const MotionSample& sample);
/// last_T_now of the lidar: base_T_lidar^-1 * base_motion * base_T_lidar. theta is not wrapped.
[[nodiscard]] Pose2d lidar_motion(const DriveParameters& drive, const MotionSample& sample);
/// Derivative of `lidar_motion` by the six parameters.
[[nodiscard]] DriveJacobian lidar_motion_jacobian(const DriveParameters& drive,
                                                  const MotionSample& sample);
/// Measured minus predicted motion; theta wrapped.
[[nodiscard]] Pose2d motion_residual(const DriveParameters& drive, const MotionSample& sample);

}  // namespace picolo::inline v0
