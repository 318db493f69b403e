// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The vehicle against the closed forms of a circle, and what slip and scrub add.

#include "picolo/sim/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "picolo/geometry/angle.hpp"

namespace picolo::sim {
namespace {

constexpr VehicleConfig kIdeal{.slip_sigma = 0.0, .scrub_s = 0.0};

void drive(Vehicle& vehicle, const DriveCommand& command, Duration duration) {
  for (Duration t{}; t < duration; t += Vehicle::kStep) { vehicle.step(command); }
}

TEST(Vehicle, GivenAConstantTwistThenItDrivesACircle) {
  const auto vehicle = std::make_unique<Vehicle>(kIdeal, Pose2d{1, 2, 0.5}, 1);
  drive(*vehicle, {.speed_mps = 0.6, .omega_radps = 0.3}, 4s);
  const double radius_m = 0.6 / 0.3;
  const double heading_rad = 0.5 + 0.3 * 4;
  const Pose2d& pose = vehicle->state().world_T_base;
  EXPECT_NEAR(pose.x_m, 1 + radius_m * (std::sin(heading_rad) - std::sin(0.5)), 1e-9);
  EXPECT_NEAR(pose.y_m, 2 - radius_m * (std::cos(heading_rad) - std::cos(0.5)), 1e-9);
  EXPECT_NEAR(pose.theta_rad, heading_rad, 1e-9);
}

TEST(Vehicle, GivenNoSlipThenTheWheelsTurnByGroundDistanceOverTheirOwnRadius) {
  const auto vehicle = std::make_unique<Vehicle>(kIdeal, Pose2d{}, 1);
  drive(*vehicle, {.speed_mps = 0.5, .omega_radps = -0.4}, 3s);
  const auto& angle_rad = vehicle->state().wheel_angle_rad;
  const double half_turn_m = -0.4 * 3 * 0.5 * kIdeal.track_m;
  EXPECT_NEAR(angle_rad[0], (0.5 * 3 - half_turn_m) / kIdeal.radius_left_m, 1e-9);
  EXPECT_NEAR(angle_rad[1], (0.5 * 3 + half_turn_m) / kIdeal.radius_right_m, 1e-9);
}

TEST(Vehicle, GivenInstantsBetweenStepsThenTheStateLiesOnTheArc) {
  const auto vehicle = std::make_unique<Vehicle>(kIdeal, Pose2d{}, 1);
  drive(*vehicle, {.speed_mps = 1.0, .omega_radps = 1.0}, 2s);
  for (const Duration t : {Duration{0}, Duration{333}, Duration{1'000'001}, Duration{1'999'999}}) {
    const auto state = vehicle->at(t);
    ASSERT_TRUE(state);
    const double angle_rad = static_cast<double>(t.count()) * 1e-6;
    EXPECT_EQ(state->elapsed, t);
    EXPECT_NEAR(state->world_T_base.x_m, std::sin(angle_rad), 2e-7);
    EXPECT_NEAR(state->world_T_base.y_m, 1 - std::cos(angle_rad), 2e-7);
    EXPECT_NEAR(state->world_T_base.theta_rad, angle_rad, 1e-9);
    EXPECT_NEAR(state->wheel_angle_rad[1],
                angle_rad * (1 + 0.5 * kIdeal.track_m) / kIdeal.radius_right_m, 1e-8);
  }
}

TEST(Vehicle, GivenInstantsAheadOrForgottenThenOutOfRange) {
  const auto vehicle = std::make_unique<Vehicle>(kIdeal, Pose2d{}, 1);
  EXPECT_EQ(vehicle->at(Duration{-1}).status(), Status::out_of_range);
  EXPECT_EQ(vehicle->at(Duration{1}).status(), Status::out_of_range);
  EXPECT_TRUE(vehicle->at(Duration{0}));
  drive(*vehicle, {.speed_mps = 0.1}, 10s);
  EXPECT_EQ(vehicle->at(10s + 1us).status(), Status::out_of_range);
  EXPECT_EQ(vehicle->at(1s).status(), Status::out_of_range);
  EXPECT_TRUE(vehicle->at(2s));
  EXPECT_TRUE(vehicle->at(10s));
}

TEST(Vehicle, GivenAccelerationThenItIsReportedInTheStepThatMadeIt) {
  const auto vehicle = std::make_unique<Vehicle>(kIdeal, Pose2d{}, 1);
  for (int i = 1; i <= 100; ++i) {
    vehicle->step({.speed_mps = 0.0005 * i, .omega_radps = 0.002 * i});
    EXPECT_NEAR(vehicle->state().acceleration_mps2, 0.5, 1e-9);
    EXPECT_NEAR(vehicle->state().alpha_radps2, 2.0, 1e-9);
  }
  vehicle->step({.speed_mps = 0.05, .omega_radps = 0.2});
  EXPECT_EQ(vehicle->state().acceleration_mps2, 0.0);
}

TEST(Vehicle, GivenSlipThenTheWheelsTurnTooFarByItsSigma) {
  constexpr double kSigma = 0.02;
  const auto vehicle = std::make_unique<Vehicle>(
      VehicleConfig{.slip_sigma = kSigma, .slip_time_constant_s = 0.05, .scrub_s = 0.0}, Pose2d{},
      3);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kSteps = 100'000;  // 2000 time constants
  for (int i = 0; i < kSteps; ++i) {
    vehicle->step({.speed_mps = 1.0});
    const double slip = vehicle->state().wheel_rate_radps[0] * 0.0999 - 1.0;
    sum += slip;
    squares += slip * slip;
  }
  EXPECT_NEAR(sum / kSteps, 0.0, 4 * kSigma / std::sqrt(1000.0));
  EXPECT_NEAR(std::sqrt(squares / kSteps), kSigma, 0.1 * kSigma);
  EXPECT_NEAR(vehicle->state().world_T_base.y_m, 0.0, 1e-9) << "slip must not move the body";
}

TEST(Vehicle, GivenScrubThenACurveDriftsOutwards) {
  const auto vehicle =
      std::make_unique<Vehicle>(VehicleConfig{.slip_sigma = 0.0, .scrub_s = 0.01}, Pose2d{}, 1);
  vehicle->step({.speed_mps = 0.5, .omega_radps = 0.4});
  EXPECT_DOUBLE_EQ(vehicle->state().lateral_mps, -0.01 * 0.5 * 0.4);
}

}  // namespace
}  // namespace picolo::sim
