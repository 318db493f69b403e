// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "picolo/calibration/gyro_calibration.hpp"
#include "picolo/calibration/imu_mount.hpp"
#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

GyroReport gyro_drive(std::uint64_t seed, double bias, double scale, double outliers) {
  Random random{seed};
  GyroCalibration calibration;
  for (int k = 0; k < 400; ++k) { calibration.add_standing(bias + 0.003 * random.gaussian()); }
  for (int k = 0; k < 300; ++k) {
    const double turn = 0.2 * std::sin(0.13 * k);
    const double gyro = turn / scale + 0.2 * bias + 1e-4 * random.gaussian();
    const bool wrong = random.uniform(0.0, 1.0) < outliers;
    const double lidar = turn + (wrong ? 0.2 : 0.0) + 1e-3 * random.gaussian();
    EXPECT_EQ(calibration.add_turn(gyro, 0.2, lidar), Status::ok);
  }
  GyroReport report;
  EXPECT_EQ(calibration.solve(report), Status::ok) << to_string(report.scale_refusal.reason);
  return report;
}

TEST(GyroCalibration, FindsBiasAndScaleAndCoversThem) {
  int covered_bias = 0;
  int covered_scale = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const GyroReport report = gyro_drive(seed, 0.012, 1.03, 0.0);
    covered_bias += std::abs(report.bias_radps.value - 0.012) < 1.96 * report.bias_radps.std;
    covered_scale += std::abs(report.scale.value - 1.03) < 1.96 * report.scale.std;
    EXPECT_NEAR(report.scale.value, 1.03, 0.003);
    EXPECT_NEAR(report.drift_radps, 0.0, 0.002);
  }
  EXPECT_NEAR(covered_bias, 190, 9);
  EXPECT_NEAR(covered_scale, 190, 9);
}

TEST(GyroCalibration, WrongMatchesAreGated) {
  const GyroReport report = gyro_drive(3, -0.02, 0.97, 0.05);
  EXPECT_NEAR(report.scale.value, 0.97, 0.004);
  EXPECT_GT(report.rejected, 3U);
}

TEST(GyroCalibration, RefusesWhatTheDataDoesNotShow) {
  GyroCalibration calibration;
  GyroReport report;
  EXPECT_EQ(calibration.solve(report), Status::degenerate);
  EXPECT_EQ(report.bias_refusal, (Refusal{RefusalReason::too_little_data, Parameter::gyro_bias}));
  for (int k = 0; k < 200; ++k) {
    calibration.add_standing(0.3 + 0.001 * (k % 2));
    EXPECT_EQ(calibration.add_turn(0.001, 0.2, 0.0), Status::ok);
  }
  EXPECT_EQ(calibration.solve(report), Status::degenerate);
  EXPECT_EQ(report.bias_refusal, (Refusal{RefusalReason::inconsistent, Parameter::gyro_bias}))
      << "somebody turns it";
  EXPECT_EQ(report.scale_refusal, (Refusal{RefusalReason::straight_only, Parameter::gyro_scale}));
  EXPECT_EQ(calibration.add_turn(kNan, 0.2, 0.0), Status::invalid_argument);
  EXPECT_EQ(calibration.add_turn(0.0, 0.0, 0.0), Status::invalid_argument);
  calibration.add_standing(kNan);
  EXPECT_EQ(report.standing, 200U);
  static_assert(sizeof(GyroCalibration) < 400);
}

/// An IMU at (0.1, -0.05), turned by `yaw`, on a mount that leans a little.
AccelerationWindow felt(double yaw, int k, Random& random) {
  AccelerationWindow w;
  w.forward_mps2 = 0.4 * std::sin(0.5 * k);
  w.leftward_mps2 = 0.3 * std::cos(0.21 * k);
  w.alpha_radps2 = 0.6 * std::cos(0.33 * k);
  const double omega = 0.8 * std::sin(0.17 * k);
  w.omega2_radps2 = omega * omega;
  const double ax = w.forward_mps2 - w.alpha_radps2 * -0.05 - w.omega2_radps2 * 0.1;
  const double ay = w.leftward_mps2 + w.alpha_radps2 * 0.1 - w.omega2_radps2 * -0.05;
  const double x = random.gaussian();
  const double y = random.gaussian();
  w.felt_x_mps2 = std::cos(yaw) * ax + std::sin(yaw) * ay + 0.12 + 0.05 * x;
  w.felt_y_mps2 = std::cos(yaw) * ay - std::sin(yaw) * ax - 0.07 + 0.05 * y;
  return w;
}

TEST(ImuMount, FindsTheYawWhateverTheLeverArmAndTheTilt) {
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random{seed};
    ImuMountCalibration calibration;
    const double yaw = seed % 2 == 0 ? 0.2 : -2.9;
    for (int k = 0; k < 300; ++k) { EXPECT_EQ(calibration.add(felt(yaw, k, random)), Status::ok); }
    ImuMountReport report;
    ASSERT_EQ(calibration.solve(report), Status::ok) << to_string(report.refusal.reason);
    EXPECT_NEAR(report.yaw_rad.value, yaw, 5.0 * report.yaw_rad.std);
    covered += std::abs(report.yaw_rad.value - yaw) < 1.96 * report.yaw_rad.std;
    EXPECT_NEAR(report.tilt_x_mps2, 0.12, 0.03);
    EXPECT_NEAR(report.scale, 1.0, 0.06);
  }
  EXPECT_NEAR(covered, 95, 6);
}

TEST(ImuMount, WithoutAccelerationTheYawIsRefused) {
  ImuMountCalibration calibration;
  ImuMountReport report;
  EXPECT_EQ(calibration.solve(report), Status::degenerate);
  EXPECT_EQ(report.refusal, (Refusal{RefusalReason::too_little_data, Parameter::gyro_yaw}));
  for (int k = 0; k < 100; ++k) { EXPECT_EQ(calibration.add({.felt_x_mps2 = 0.1}), Status::ok); }
  EXPECT_EQ(calibration.solve(report), Status::degenerate);
  EXPECT_EQ(report.refusal, (Refusal{RefusalReason::constant_velocity, Parameter::gyro_yaw}));
  EXPECT_EQ(calibration.add({.felt_x_mps2 = kNan}), Status::invalid_argument);
  calibration.reset();
  EXPECT_EQ(calibration.solve(report), Status::degenerate);
  EXPECT_EQ(report.windows, 0U);
}

}  // namespace
}  // namespace picolo
