// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/wheel_model.hpp"

#include "arc.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

struct Motion {
  double length_m;
  double theta_rad;
};

Motion motion_of(const DriveParameters& drive, const MotionSample& sample) {
  const double left_m = drive.radius_left_m * (sample.duration_s * sample.left_radps);
  const double right_m = drive.radius_right_m * (sample.duration_s * sample.right_radps);
  return {0.5 * (left_m + right_m), (right_m - left_m) / drive.track_m};
}

}  // namespace

Pose2d base_motion(const DriveParameters& drive, const MotionSample& sample) {
  const Motion motion = motion_of(drive, sample);
  const Arc arc = arc_of(motion.theta_rad);
  return {motion.length_m * arc.along, motion.length_m * arc.across, motion.theta_rad};
}

Pose2d lidar_motion(const DriveParameters& drive, const MotionSample& sample) {
  const Pose2d base = base_motion(drive, sample);
  const SinCos<double> turn = sin_cos(base.theta_rad);
  const SinCos<double> yaw = sin_cos(drive.base_T_lidar.theta_rad);
  const double lx = drive.base_T_lidar.x_m;
  const double ly = drive.base_T_lidar.y_m;
  const double x = base.x_m + ((turn.cosine * lx - turn.sine * ly) - lx);
  const double y = base.y_m + ((turn.sine * lx + turn.cosine * ly) - ly);
  return {yaw.cosine * x + yaw.sine * y, yaw.cosine * y - yaw.sine * x, base.theta_rad};
}

DriveJacobian lidar_motion_jacobian(const DriveParameters& drive, const MotionSample& sample) {
  const Motion motion = motion_of(drive, sample);
  const Arc arc = arc_of(motion.theta_rad);
  const SinCos<double> turn = sin_cos(motion.theta_rad);
  const SinCos<double> yaw = sin_cos(drive.base_T_lidar.theta_rad);
  const double lx = drive.base_T_lidar.x_m;
  const double ly = drive.base_T_lidar.y_m;
  // d(x, y) / dtheta in base axes: along the arc, and of the lever arm.
  const double x_theta = motion.length_m * arc.d_along - (turn.sine * lx + turn.cosine * ly);
  const double y_theta = motion.length_m * arc.d_across + (turn.cosine * lx - turn.sine * ly);
  const double left_rad = sample.duration_s * sample.left_radps;
  const double right_rad = sample.duration_s * sample.right_radps;
  const double length[3] = {0.5 * left_rad, 0.5 * right_rad, 0.0};
  const double theta[3] = {-left_rad / drive.track_m, right_rad / drive.track_m,
                           -motion.theta_rad / drive.track_m};
  DriveJacobian j{};
  const auto put = [&](std::size_t column, double x, double y, double t) {
    j[column] = yaw.cosine * x + yaw.sine * y;
    j[6 + column] = yaw.cosine * y - yaw.sine * x;
    j[12 + column] = t;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    put(k, length[k] * arc.along + x_theta * theta[k], length[k] * arc.across + y_theta * theta[k],
        theta[k]);
  }
  put(3, turn.cosine - 1.0, turn.sine, 0.0);
  put(4, -turn.sine, turn.cosine - 1.0, 0.0);
  const Pose2d seen = lidar_motion(drive, sample);
  j[5] = seen.y_m;
  j[11] = -seen.x_m;
  return j;
}

Pose2d motion_residual(const DriveParameters& drive, const MotionSample& sample) {
  const Pose2d predicted = lidar_motion(drive, sample);
  return {sample.lidar_motion.x_m - predicted.x_m, sample.lidar_motion.y_m - predicted.y_m,
          wrap_angle(sample.lidar_motion.theta_rad - predicted.theta_rad)};
}

}  // namespace picolo::inline v0
