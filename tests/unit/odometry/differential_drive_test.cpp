// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/differential_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace picolo {
namespace {

WheelTicks ticks(int ms, std::int64_t left, std::int64_t right) {
  WheelTicks sample{.stamp = Timestamp{Duration{ms * 1000}}};
  sample.ticks = {left, right, 0, 0};
  return sample;
}

// 2 pi * 0.1 m / 6283.185... counts: one count is 0.1 mm.
constexpr DifferentialDriveConfig kTenthOfMillimetre{
    .left_radius_m = 0.1,
    .right_radius_m = 0.1,
    .track_m = 0.5,
    .counts_per_revolution = 2000.0 * std::numbers::pi};

TEST(DifferentialDrive, FirstSampleOnlySetsTheBase) {
  DifferentialDrive drive{kTenthOfMillimetre};
  EXPECT_EQ(drive.update(ticks(0, 123456, -98765)).status(), Status::not_ready);
  const Result<WheelIncrement> still = drive.update(ticks(10, 123456, -98765));
  ASSERT_TRUE(still);
  EXPECT_TRUE(still->standing);
  EXPECT_EQ(still->from_T_to, Pose2d{});
}

TEST(DifferentialDrive, StraightTurnAndArcHaveTheirClosedForms) {
  DifferentialDrive drive{kTenthOfMillimetre};
  ASSERT_FALSE(drive.update(ticks(0, 0, 0)));
  const Pose2d straight = drive.update(ticks(10, 10000, 10000))->from_T_to;
  EXPECT_NEAR(straight.x_m, 1.0, 1e-12);
  EXPECT_NEAR(straight.theta_rad, 0.0, 1e-12);
  const Pose2d turn = drive.update(ticks(20, 10000 - 2500, 10000 + 2500))->from_T_to;
  EXPECT_NEAR(turn.x_m, 0.0, 1e-12);
  EXPECT_NEAR(turn.theta_rad, 1.0, 1e-12);
  // Left 0.75 m, right 1.25 m: an arc of 1 m and 1 rad, radius 1 m around the left.
  const Pose2d arc = drive.update(ticks(30, 7500 + 7500, 12500 + 12500))->from_T_to;
  EXPECT_NEAR(arc.x_m, std::sin(1.0), 1e-12);
  EXPECT_NEAR(arc.y_m, 1.0 - std::cos(1.0), 1e-12);
  EXPECT_NEAR(arc.theta_rad, 1.0, 1e-12);
}

TEST(DifferentialDrive, UnequalRadiiCurveAStraight) {
  DifferentialDriveConfig config = kTenthOfMillimetre;
  config.right_radius_m = 0.101;
  DifferentialDrive drive{config};
  ASSERT_FALSE(drive.update(ticks(0, 0, 0)));
  EXPECT_NEAR(drive.update(ticks(10, 10000, 10000))->from_T_to.theta_rad, 0.01 / 0.5, 1e-12);
}

TEST(DifferentialDrive, AMatrixMultipliesEachIncrement) {
  DifferentialDriveConfig config = kTenthOfMillimetre;
  config.correction = Matrix3d{{1.1, 0.2, 0.3, 0.4, 1.5, 0.6, 0.7, 0.8, 1.9}};
  DifferentialDrive plain{kTenthOfMillimetre};
  DifferentialDrive drive{config};
  ASSERT_FALSE(plain.update(ticks(0, 0, 0)));
  ASSERT_FALSE(drive.update(ticks(0, 0, 0)));
  const Pose2d o = plain.update(ticks(10, 7500, 12500))->from_T_to;
  const Pose2d s = drive.update(ticks(10, 7500, 12500))->from_T_to;
  EXPECT_NEAR(s.x_m, 1.1 * o.x_m + 0.2 * o.y_m + 0.3 * o.theta_rad, 1e-12);
  EXPECT_NEAR(s.y_m, 0.4 * o.x_m + 1.5 * o.y_m + 0.6 * o.theta_rad, 1e-12);
  EXPECT_NEAR(s.theta_rad, 0.7 * o.x_m + 0.8 * o.y_m + 1.9 * o.theta_rad, 1e-12);
}

TEST(DifferentialDrive, ARestartedCounterIsABaseAndNotAMotion) {
  DifferentialDrive drive{kTenthOfMillimetre};
  ASSERT_FALSE(drive.update(ticks(0, 5000, 5000)));
  WheelTicks restarted = ticks(10, 0, 0);
  restarted.restarted = true;
  EXPECT_EQ(drive.update(restarted).status(), Status::not_ready);
  EXPECT_NEAR(drive.update(ticks(20, 100, 100))->from_T_to.x_m, 0.01, 1e-12);
}

TEST(DifferentialDrive, SamplesThatAreNotNewerAreIgnored) {
  DifferentialDrive drive{kTenthOfMillimetre};
  ASSERT_FALSE(drive.update(ticks(10, 0, 0)));
  EXPECT_EQ(drive.update(ticks(10, 100, 100)).status(), Status::out_of_range);
  EXPECT_EQ(drive.update(ticks(5, 100, 100)).status(), Status::out_of_range);
  EXPECT_NEAR(drive.update(ticks(20, 100, 100))->from_T_to.x_m, 0.01, 1e-12);
}

TEST(DifferentialDriveConfig, RefusesZeroes) {
  EXPECT_TRUE(DifferentialDriveConfig{}.valid());
  EXPECT_FALSE((DifferentialDriveConfig{.track_m = 0.0}).valid());
  EXPECT_FALSE((DifferentialDriveConfig{.counts_per_revolution = -1.0}).valid());
}

}  // namespace
}  // namespace picolo
