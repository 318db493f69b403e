// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Routes and scripts: bounded, smooth, and finished when they are.

#include "picolo/sim/drive_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace picolo::sim {
namespace {

constexpr double kStepS = 1e-3;

struct Ride {
  Ride(const DriveLimits& drive_limits, DrivePlan drive_plan, const Pose2d& start)
      : limits(drive_limits),
        plan(drive_plan),
        vehicle(VehicleConfig{.slip_sigma = 0.0, .scrub_s = 0.0}, start, 1) {}

  void step() {
    const VehicleState before = vehicle.state();
    const DriveCommand command = plan.next(before);
    EXPECT_LE(std::abs(command.speed_mps), limits.max_speed_mps + 1e-12);
    EXPECT_LE(std::abs(command.omega_radps), limits.max_omega_radps + 1e-12);
    EXPECT_LE(std::abs(command.speed_mps - before.speed_mps),
              limits.max_acceleration_mps2 * kStepS + 1e-12);
    EXPECT_LE(std::abs(command.omega_radps - before.omega_radps),
              limits.max_alpha_radps2 * kStepS + 1e-12);
    vehicle.step(command);
  }
  void until(Duration end) {
    while (vehicle.state().elapsed < end) { step(); }
  }

  DriveLimits limits;
  DrivePlan plan;
  Vehicle vehicle;
};

Route route_of(std::initializer_list<Point2d> points) {
  Route route;
  for (const Point2d& point : points) { EXPECT_TRUE(route.push_back(point)); }
  return route;
}

TEST(DrivePlan, GivenAnOpenRouteThenItEndsOnItsLastPointAndStands) {
  const DriveLimits limits;
  const auto ride = std::make_unique<Ride>(
      limits, DrivePlan{limits, route_of({{0, 0}, {3, 0}, {3, 3}}), false, {}}, Pose2d{});
  ride->until(limits.stand_at_start);
  EXPECT_EQ(ride->vehicle.state().world_T_base, Pose2d{});
  ride->until(60s);
  EXPECT_TRUE(ride->plan.finished());
  EXPECT_NEAR(ride->vehicle.state().world_T_base.x_m, 3.0, 0.1);
  EXPECT_NEAR(ride->vehicle.state().world_T_base.y_m, 3.0, 0.1);
  EXPECT_EQ(ride->vehicle.state().speed_mps, 0.0);
}

TEST(DrivePlan, GivenAnAboutTurnThenItTurnsOnTheSpot) {
  const DriveLimits limits;
  const auto ride = std::make_unique<Ride>(
      limits, DrivePlan{limits, route_of({{0, 0}, {-2, 0}}), false, {}}, Pose2d{});
  double worst_m = 0.0;
  while (ride->vehicle.state().elapsed < 30s) {
    ride->step();
    worst_m = std::max(worst_m, std::abs(ride->vehicle.state().world_T_base.y_m));
    worst_m = std::max(worst_m, ride->vehicle.state().world_T_base.x_m);
  }
  EXPECT_TRUE(ride->plan.finished());
  EXPECT_LT(worst_m, 0.15);
}

TEST(DrivePlan, GivenAClosedRouteThenItGoesRoundForEver) {
  const DriveLimits limits;
  const auto ride = std::make_unique<Ride>(
      limits, DrivePlan{limits, route_of({{0, 0}, {2, 0}, {2, 2}, {0, 2}}), true, {}}, Pose2d{});
  double turned_rad = 0.0;
  while (ride->vehicle.state().elapsed < 120s) {
    ride->step();
    turned_rad += ride->vehicle.state().omega_radps * kStepS;
  }
  EXPECT_FALSE(ride->plan.finished());
  EXPECT_GT(turned_rad, 6.0 * 2 * 3.14) << "six laps of 8 m at 0.6 m/s";
}

TEST(DrivePlan, GivenAScriptThenItsPiecesAreDrivenOneAfterTheOther) {
  const DriveLimits limits{
      .stand_at_start = 500ms, .max_acceleration_mps2 = 100.0, .max_alpha_radps2 = 100.0};
  TwistScript script;
  ASSERT_TRUE(script.push_back({.duration = 2s, .speed_mps = 0.5}));
  ASSERT_TRUE(script.push_back({.duration = 1s, .omega_radps = -0.5}));
  ASSERT_TRUE(script.push_back({.duration = 1s, .speed_mps = -0.4}));
  const auto ride = std::make_unique<Ride>(
      limits, DrivePlan{limits, route_of({{9, 9}, {8, 8}}), true, script}, Pose2d{});
  ride->until(2500ms);
  EXPECT_NEAR(ride->vehicle.state().world_T_base.x_m, 1.0, 0.01);
  ride->until(3500ms);
  EXPECT_NEAR(ride->vehicle.state().world_T_base.theta_rad, -0.5, 0.01);
  EXPECT_FALSE(ride->plan.finished());
  ride->until(6s);
  EXPECT_TRUE(ride->plan.finished());
  EXPECT_NEAR(ride->vehicle.state().world_T_base.x_m, 1.0 - 0.4 * std::cos(0.5), 0.02);
  EXPECT_EQ(ride->vehicle.state().speed_mps, 0.0);
}

TEST(DrivePlan, GivenAScriptBeyondTheLimitsThenTheLimitsHold) {
  const DriveLimits limits;
  TwistScript script;
  ASSERT_TRUE(script.push_back({.duration = 5s, .speed_mps = 9.0, .omega_radps = -9.0}));
  const auto ride = std::make_unique<Ride>(limits, DrivePlan{limits, {}, true, script}, Pose2d{});
  ride->until(5s);
  EXPECT_DOUBLE_EQ(ride->vehicle.state().speed_mps, limits.max_speed_mps);
  EXPECT_DOUBLE_EQ(ride->vehicle.state().omega_radps, -limits.max_omega_radps);
}

TEST(DrivePlan, GivenNoRouteThenItStands) {
  const DriveLimits limits;
  const auto ride =
      std::make_unique<Ride>(limits, DrivePlan{limits, route_of({{0, 0}}), true, {}}, Pose2d{});
  ride->until(3s);
  EXPECT_TRUE(ride->plan.finished());
  EXPECT_EQ(ride->vehicle.state().world_T_base, Pose2d{});
}

class EveryScene : public ::testing::TestWithParam<SceneName> {};

TEST_P(EveryScene, StartsOnItsRouteInsideOfItsWalls) {
  const Scene scene = make_scene(GetParam());
  ASSERT_GE(scene.route.size(), 2U);
  EXPECT_EQ(scene.world_T_start.x_m, scene.route[0].x_m);
  EXPECT_EQ(scene.world_T_start.y_m, scene.route[0].y_m);
  for (int k = 0; k < 360; ++k) {
    const double range_m = scene.world.cast(scene.route[0], k * 0.0174533, 50.0);
    EXPECT_GT(range_m, 0.3) << "no wall, or too near, at " << k << " deg";
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene,
                         ::testing::Values(SceneName::office, SceneName::room, SceneName::corridor,
                                           SceneName::hall));

}  // namespace
}  // namespace picolo::sim
