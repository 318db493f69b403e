// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The motion from an IMU against closed forms, and every sample that must be refused.

#include "picolo/undistort/imu_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace picolo {
namespace {

ImuSample at_ms(int ms, double rate_radps, double ax = 0.0, double ay = 0.0) {
  ImuSample sample{.stamp = Timestamp{Duration{ms * 1000}}};
  sample.rate_radps = {0.0F, 0.0F, static_cast<float>(rate_radps)};
  sample.acceleration_mps2 = {static_cast<float>(ax), static_cast<float>(ay), 9.81F};
  return sample;
}

TEST(ImuMotion, GivenAConstantRateThenTheYawIsItsIntegralAndNothingMoves) {
  PoseBuffer<64> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion;
  for (int ms = 0; ms <= 100; ms += 5) { ASSERT_EQ(motion.add(at_ms(ms, 1.5), core), Status::ok); }
  EXPECT_NEAR(motion.pose().odom_T_base.theta_rad, 0.15, 1e-9);
  EXPECT_EQ(motion.pose().odom_T_base.x_m, 0.0);
  const auto half = core.at(Timestamp{Duration{52'500}});
  ASSERT_TRUE(half);
  EXPECT_NEAR((*half).theta_rad, 0.07875, 1e-9);
}

TEST(ImuMotion, GivenARateThatRampsThenTheTrapezoidIsExact) {
  PoseBuffer<64> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion;
  for (int ms = 0; ms <= 200; ms += 10) {
    ASSERT_EQ(motion.add(at_ms(ms, 0.01 * ms), core), Status::ok);
  }
  EXPECT_NEAR(motion.pose().odom_T_base.theta_rad, 0.5 * 2.0 * 0.2, 1e-7);
}

TEST(ImuMotion, GivenBiasAndAnUpsideDownSensorThenBothAreTakenOut) {
  PoseBuffer<64> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion{{.gyro_sign = -1.0F}};
  motion.set_bias(-0.2F);  // of the turned rate
  for (int ms = 0; ms <= 100; ms += 5) {
    ASSERT_EQ(motion.add(at_ms(ms, -(1.0 - 0.2)), core), Status::ok);
  }
  EXPECT_NEAR(motion.pose().odom_T_base.theta_rad, 0.1, 1e-7);
}

TEST(ImuMotion, GivenAVelocityFromTheWheelsThenThePathIsAnArc) {
  PoseBuffer<256> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion;
  motion.set_velocity(2.0F, 0.0F);
  for (int ms = 0; ms <= 1000; ms += 5) { ASSERT_EQ(motion.add(at_ms(ms, 1.0), core), Status::ok); }
  EXPECT_NEAR(motion.pose().odom_T_base.x_m, 2.0 * std::sin(1.0), 1e-6);
  EXPECT_NEAR(motion.pose().odom_T_base.y_m, 2.0 * (1.0 - std::cos(1.0)), 1e-6);
}

TEST(ImuMotion, GivenAccelerationsThenTheyAreIntegratedTwiceInAxesThatTurn) {
  // On a circle at constant speed the specific force is centripetal: v omega to the left.
  PoseBuffer<512> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion{{.use_accelerometer = true}};
  motion.set_velocity(2.0F, 0.0F);
  for (int ms = 0; ms <= 1000; ms += 2) {
    ASSERT_EQ(motion.add(at_ms(ms, 1.0, 0.0, 2.0), core), Status::ok);
  }
  EXPECT_NEAR(motion.pose().odom_T_base.x_m, 2.0 * std::sin(1.0), 5e-3);
  EXPECT_NEAR(motion.pose().odom_T_base.y_m, 2.0 * (1.0 - std::cos(1.0)), 5e-3);

  PoseBufferCore straight = poses.core();
  ImuMotion start{{.use_accelerometer = true}};
  for (int ms = 0; ms <= 1000; ms += 2) {
    ASSERT_EQ(start.add(at_ms(ms, 0.0, 1.0, 0.0), straight), Status::ok);
  }
  EXPECT_NEAR(start.pose().odom_T_base.x_m, 0.5, 1e-3);
}

TEST(ImuMotion, GivenAGapThenThePosesBeginAnew) {
  PoseBuffer<64> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion{{.max_gap = 20ms}};
  ASSERT_EQ(motion.add(at_ms(0, 1.0), core), Status::ok);
  ASSERT_EQ(motion.add(at_ms(20, 1.0), core), Status::ok);
  EXPECT_EQ(core.size(), 2U);
  ASSERT_EQ(motion.add(at_ms(41, 1.0), core), Status::ok);
  EXPECT_EQ(core.size(), 1U);
  EXPECT_EQ(motion.gaps(), 1U);
  EXPECT_NEAR(motion.pose().odom_T_base.theta_rad, 0.02, 1e-9) << "nothing is made up for the gap";
}

TEST(ImuMotion, GivenStaleSaturatedOrNonsenseSamplesThenNothingChanges) {
  PoseBuffer<64> poses;
  PoseBufferCore core = poses.core();
  ImuMotion motion;
  ASSERT_EQ(motion.add(at_ms(10, 1.0), core), Status::ok);
  EXPECT_EQ(motion.add(at_ms(10, 1.0), core), Status::out_of_range);
  EXPECT_EQ(motion.add(at_ms(5, 1.0), core), Status::out_of_range);
  EXPECT_EQ(motion.add(at_ms(20, std::numeric_limits<double>::quiet_NaN()), core),
            Status::invalid_argument);
  ImuSample saturated = at_ms(20, 1.0);
  saturated.saturated = true;
  EXPECT_EQ(motion.add(saturated, core), Status::invalid_argument);
  EXPECT_EQ(core.size(), 1U);
  EXPECT_EQ(motion.pose().stamp, at_ms(10, 0).stamp);
}

}  // namespace
}  // namespace picolo
