// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Ackermann and mecanum drives against closed forms and fine integration; every model's Jacobian
// against differences.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "picolo/odometry/ackermann_drive.hpp"
#include "picolo/odometry/differential_drive.hpp"
#include "picolo/odometry/mecanum_drive.hpp"

namespace picolo {
namespace {

// A thousandth of a microradian a count: what is tested is the model, not its encoders.
constexpr double kCounts = 2.0 * std::numbers::pi * 1e9;
constexpr double kPerRad = 1e9;

using Turned = std::array<double, kMaxWheels>;  // what each encoder turned, rad

WheelTicks ticks(int ms, const Turned& turned_rad) {
  WheelTicks sample{.stamp = Timestamp{Duration{ms * 1000}}};
  for (std::size_t k = 0; k < kMaxWheels; ++k) {
    sample.ticks[k] = std::llround(turned_rad[k] * kPerRad);
  }
  return sample;
}

template <typename Drive>
Pose2d motion(Drive drive, const Turned& from, const Turned& to) {
  EXPECT_EQ(drive.update(ticks(0, from)).status(), Status::not_ready);
  const auto increment = drive.update(ticks(10, to));
  EXPECT_TRUE(increment);
  return increment ? increment->from_T_to : Pose2d{};
}

template <typename Drive>
void expect_jacobian(const Drive& drive, const Turned& from, const Turned& to) {
  Drive at = drive;
  ASSERT_EQ(at.update(ticks(0, from)).status(), Status::not_ready);
  ASSERT_TRUE(at.update(ticks(10, to)));
  constexpr double kStep_rad = 1e-4;
  for (std::size_t k = 0; k < kMaxWheels; ++k) {
    Turned more = to;
    Turned less = to;
    more[k] += kStep_rad;
    less[k] -= kStep_rad;
    const Pose2d high = motion(drive, from, more);
    const Pose2d low = motion(drive, from, less);
    const std::array<double, 3> difference{high.x_m - low.x_m, high.y_m - low.y_m,
                                           high.theta_rad - low.theta_rad};
    for (std::size_t row = 0; row < 3; ++row) {
      EXPECT_NEAR(at.jacobian().d[row][k], difference[row] / (2.0 * kStep_rad), 2e-6)
          << "row " << row << " encoder " << k;
    }
  }
}

const Turned kRest{};
constexpr std::array<Turned, 4> kMotions{{{0.3, 0.31, 0.29, 0.305},
                                          {2.0, 0.4, -0.7, 1.1},
                                          {-3.0, 3.0, -2.0, 2.5},
                                          {0.0, 0.0, 0.0, 0.0}}};

DifferentialDriveConfig differential() {
  return {.left_radius_m = 0.1,
          .right_radius_m = 0.11,
          .track_m = 0.5,
          .counts_per_revolution = kCounts};
}
MecanumDriveConfig mecanum() {
  return {.radius_m = {0.05, 0.051, 0.049, 0.05},
          .track_m = 0.4,
          .wheelbase_m = 0.3,
          .counts_per_revolution = kCounts};
}
AckermannDriveConfig ackermann(DrivenAxle driven, double wheelbase_m = 1.2) {
  return {.wheel_radius_m = 0.15,
          .wheelbase_m = wheelbase_m,
          .counts_per_revolution = kCounts,
          .steering_counts_per_turn = kCounts,
          .driven = driven};
}

TEST(WheelJacobians, AgreeWithDifferences) {
  for (const Turned& to : kMotions) {
    expect_jacobian(DifferentialDrive{differential()}, kRest, to);
    DifferentialDriveConfig corrected = differential();
    corrected.correction = {{1.01, 0.02, 0.003, -0.01, 0.98, 0.05, 0.02, 0.01, 1.03}};
    expect_jacobian(DifferentialDrive{corrected}, kRest, to);
    expect_jacobian(MecanumDrive{mecanum()}, kRest, to);
    for (const DrivenAxle driven : {DrivenAxle::fixed, DrivenAxle::steered}) {
      const Turned steered{to[0], 0.4, 0.0, 0.0};
      expect_jacobian(AckermannDrive{ackermann(driven)}, Turned{0.0, 0.3, 0.0, 0.0}, steered);
      expect_jacobian(AckermannDrive{ackermann(driven, -0.9)}, Turned{0.0, -0.8, 0.0, 0.0},
                      steered);
    }
  }
}

TEST(MecanumDrive, RollsForwardSidewaysAndTurns) {
  MecanumDriveConfig config = mecanum();
  config.radius_m = {0.05, 0.05, 0.05, 0.05};
  const MecanumDrive drive{config};
  const Pose2d forward = motion(drive, kRest, {2.0, 2.0, 2.0, 2.0});
  EXPECT_NEAR(forward.x_m, 0.1, 1e-9);
  EXPECT_NEAR(std::abs(forward.y_m) + std::abs(forward.theta_rad), 0.0, 1e-9);
  const Pose2d left = motion(drive, kRest, {-2.0, 2.0, 2.0, -2.0});
  EXPECT_NEAR(left.y_m, 0.1, 1e-9);
  EXPECT_NEAR(std::abs(left.x_m) + std::abs(left.theta_rad), 0.0, 1e-9);
  const Pose2d turn = motion(drive, kRest, {-2.0, 2.0, -2.0, 2.0});
  EXPECT_NEAR(turn.theta_rad, 0.1 / 0.35, 1e-9);
  EXPECT_NEAR(std::abs(turn.x_m) + std::abs(turn.y_m), 0.0, 1e-9);
  // Sideways while turning: an arc about a point ahead; exact for constant speeds.
  const Pose2d arc = motion(drive, kRest, {-4.0, 4.0, 0.0, 0.0});
  const double angle = 0.1 / 0.35;
  EXPECT_NEAR(arc.x_m, -0.1 * (1.0 - std::cos(angle)) / angle, 1e-9);
  EXPECT_NEAR(arc.y_m, 0.1 * std::sin(angle) / angle, 1e-9);
}

TEST(MecanumDrive, SlipIsWhatNoMotionExplains) {
  MecanumDriveConfig config = mecanum();
  config.radius_m = {0.05, 0.05, 0.05, 0.05};
  MecanumDrive drive{config};
  ASSERT_FALSE(drive.update(ticks(0, kRest)));
  ASSERT_TRUE(drive.update(ticks(10, {1.0, 3.0, -1.0, 1.0})));
  EXPECT_NEAR(drive.slip_m(), 0.05, 1e-9);
  ASSERT_TRUE(drive.update(ticks(20, {2.0, 4.0, 0.0, 2.0})));
  EXPECT_NEAR(drive.slip_m(), 0.0, 1e-9);
}

TEST(AckermannDrive, RestingSteeringDrivesACircle) {
  const Turned straight{0.0, 0.0, 0.0, 0.0};
  const Pose2d ahead =
      motion(AckermannDrive{ackermann(DrivenAxle::fixed)}, straight, {2.0, 0.0, 0.0, 0.0});
  EXPECT_NEAR(ahead.x_m, 0.3, 1e-9);
  EXPECT_NEAR(ahead.theta_rad, 0.0, 1e-9);
  // tan(steering) = 0.6 of 1.2 m: a circle of 2 m radius. The path at the fixed axle is 1 m, ...
  const double steering = std::atan(0.6);
  const Pose2d left = motion(AckermannDrive{ackermann(DrivenAxle::fixed)},
                             {0.0, steering, 0.0, 0.0}, {1.0 / 0.15, steering, 0.0, 0.0});
  EXPECT_NEAR(left.theta_rad, 0.5, 1e-8);
  EXPECT_NEAR(left.x_m, 2.0 * std::sin(0.5), 1e-8);
  EXPECT_NEAR(left.y_m, 2.0 * (1.0 - std::cos(0.5)), 1e-8);
  // ... at the steered wheel, on the larger circle, longer.
  const double steered_path = std::hypot(2.0, 1.2) * 0.5;
  const Pose2d same = motion(AckermannDrive{ackermann(DrivenAxle::steered)},
                             {0.0, steering, 0.0, 0.0}, {steered_path / 0.15, steering, 0.0, 0.0});
  EXPECT_NEAR(same.x_m, left.x_m, 1e-8);
  EXPECT_NEAR(same.y_m, left.y_m, 1e-8);
  EXPECT_NEAR(same.theta_rad, left.theta_rad, 1e-8);
}

TEST(AckermannDrive, ADrivingWheelAtARightAngleTurnsOnTheSpot) {
  AckermannDriveConfig config = ackermann(DrivenAxle::steered);
  config.max_steering_rad = 1.6;
  ASSERT_TRUE(config.valid());
  const double right_angle = std::numbers::pi / 2.0;
  const Pose2d turn =
      motion(AckermannDrive{config}, {0.0, right_angle, 0.0, 0.0}, {1.0, right_angle, 0.0, 0.0});
  EXPECT_NEAR(turn.x_m, 0.0, 1e-8);
  EXPECT_NEAR(turn.theta_rad, 0.15 / 1.2, 1e-8);
  config.driven = DrivenAxle::fixed;
  EXPECT_FALSE(config.valid()) << "tan has no value there";
}

TEST(AckermannDrive, MovingSteeringIsFollowedToSecondOrder) {
  // A lane change: the steering swings left and right while the vehicle drives 4 m.
  const AckermannDriveConfig config = ackermann(DrivenAxle::fixed);
  const auto drive_in = [&](int steps) {
    AckermannDrive drive{config};
    Pose2d pose{};
    for (int k = 0; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const double steering = 0.5 * std::sin(2.0 * std::numbers::pi * share);
      const auto step = drive.update(ticks(k + 1, {share * 4.0 / 0.15, steering, 0.0, 0.0}));
      if (step) { pose = pose * step->from_T_to; }
    }
    return pose;
  };
  const Pose2d fine = drive_in(4096);
  const auto error = [&](int steps) {
    const Pose2d pose = drive_in(steps);
    return std::hypot(pose.x_m - fine.x_m, pose.y_m - fine.y_m);
  };
  EXPECT_GT(fine.y_m, 0.5);
  EXPECT_LT(error(64), 2e-3);
  EXPECT_NEAR(error(64) / error(128), 4.0, 0.5);
}

TEST(AckermannDrive, ASteeringBeyondItsLimitGivesNoMotionAndTheNextGoesOnFromThere) {
  AckermannDriveConfig config = ackermann(DrivenAxle::fixed);
  config.max_steering_rad = 0.6;
  AckermannDrive drive{config};
  ASSERT_FALSE(drive.update(ticks(0, kRest)));
  EXPECT_EQ(drive.update(ticks(10, {1.0, 1.4, 0.0, 0.0})).status(), Status::out_of_range);
  EXPECT_EQ(drive.update(ticks(5, {1.0, 0.0, 0.0, 0.0})).status(), Status::out_of_range);
  ASSERT_EQ(drive.update(ticks(20, {2.0, -1.4, 0.0, 0.0})).status(), Status::ok);
}

TEST(WheelModels, RestartAndOrderAreThoseOfTheConcept) {
  MecanumDrive drive{mecanum()};
  EXPECT_EQ(drive.update(ticks(10, kRest)).status(), Status::not_ready);
  EXPECT_EQ(drive.update(ticks(10, kRest)).status(), Status::out_of_range);
  const auto still = drive.update(ticks(20, kRest));
  ASSERT_TRUE(still);
  EXPECT_TRUE(still->standing);
  WheelTicks restarted = ticks(30, {9.0, 9.0, 9.0, 9.0});
  restarted.restarted = true;
  EXPECT_EQ(drive.update(restarted).status(), Status::not_ready);
  MecanumDriveConfig bad = mecanum();
  bad.radius_m[2] = 0.0;
  EXPECT_FALSE(bad.valid());
}

}  // namespace
}  // namespace picolo
