// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/wheel_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "picolo/core/random.hpp"
#include "simulated_drive.hpp"

namespace picolo {
namespace {

DriveParameters nudged(DriveParameters d, std::size_t k, double step) {
  const std::array<double*, 6> all{&d.radius_left_m,    &d.radius_right_m,
                                   &d.track_m,          &d.base_T_lidar.x_m,
                                   &d.base_T_lidar.y_m, &d.base_T_lidar.theta_rad};
  *all[k] += step;
  return d;
}

TEST(WheelModel, JacobianMatchesDifferences) {
  Random random{5};
  for (int trial = 0; trial < 300; ++trial) {
    DriveParameters d = test::truth();
    d.base_T_lidar.theta_rad = random.uniform(-3.0, 3.0);
    const double scale = trial % 3 == 0   ? 1e-4
                         : trial % 3 == 1 ? 0.3
                                          : 6.0;  // series, its border, closed form
    MotionSample sample;
    sample.duration_s = random.uniform(0.05, 1.0);
    sample.left_radps = random.uniform(-scale, scale);
    sample.right_radps = random.uniform(-scale, scale);
    const DriveJacobian analytic = lidar_motion_jacobian(d, sample);
    for (std::size_t k = 0; k < 6; ++k) {
      constexpr double kStep = 1e-6;
      const Pose2d high = lidar_motion(nudged(d, k, kStep), sample);
      const Pose2d low = lidar_motion(nudged(d, k, -kStep), sample);
      EXPECT_NEAR(analytic[k], (high.x_m - low.x_m) / (2 * kStep), 2e-8);
      EXPECT_NEAR(analytic[6 + k], (high.y_m - low.y_m) / (2 * kStep), 2e-8);
      EXPECT_NEAR(analytic[12 + k], (high.theta_rad - low.theta_rad) / (2 * kStep), 2e-8);
    }
  }
}

TEST(WheelModel, LidarMotionIsTheBaseMotionSeenThroughTheMount) {
  Random random{6};
  for (int trial = 0; trial < 100; ++trial) {
    MotionSample sample{0.5, 0.0, 0.0, {}};
    sample.left_radps = random.uniform(-5.0, 5.0);
    sample.right_radps = random.uniform(-5.0, 5.0);
    const DriveParameters d = test::truth();
    const Pose2d expected = inverse(d.base_T_lidar) * base_motion(d, sample) * d.base_T_lidar;
    const Pose2d found = lidar_motion(d, sample);
    EXPECT_NEAR(found.x_m, expected.x_m, 1e-14);
    EXPECT_NEAR(found.y_m, expected.y_m, 1e-14);
    EXPECT_NEAR(wrap_angle(found.theta_rad - expected.theta_rad), 0.0, 1e-14);
  }
}

TEST(WheelModel, HalvesOfAnArcComposeToTheWhole) {
  const DriveParameters d = test::truth();
  const MotionSample whole{0.4, 3.0, 5.0, {}};
  const MotionSample half{0.2, 3.0, 5.0, {}};
  const Pose2d twice = base_motion(d, half) * base_motion(d, half);
  const Pose2d once = base_motion(d, whole);
  EXPECT_NEAR(twice.x_m, once.x_m, 1e-15);
  EXPECT_NEAR(twice.y_m, once.y_m, 1e-15);
}

}  // namespace
}  // namespace picolo
