// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Where the scan leaves a direction open, the odometry carries it: corridor, single wall, circle,
// open space.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/localisation/localiser.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

constexpr double kReach_m = 12.0;
constexpr int kBeams = 450;

std::vector<test::Wall> round_room(double radius_m) {
  std::vector<test::Wall> walls;
  constexpr int kSides = 180;
  for (int i = 0; i < kSides; ++i) {
    const double from = 2.0 * std::numbers::pi * i / kSides;
    const double to = 2.0 * std::numbers::pi * (i + 1) / kSides;
    walls.push_back({radius_m * std::cos(from), radius_m * std::sin(from), radius_m * std::cos(to),
                     radius_m * std::sin(to)});
  }
  return walls;
}

/// How a world lies across the cells of the map, and whether beams are evenly spaced.
struct Setting {
  double map_yaw_start_rad = 0.0;
  bool even_beams = false;
};

/// A drive by equal steps with odometry that errs by a share of each step, and range noise of 1 cm.
struct Outcome {
  double along_m = 0.0;  // errors at the end, in the axes of the truth's start
  double across_m = 0.0;
  double heading_rad = 0.0;
  double odometry_m = 0.0;
  double odometry_heading_rad = 0.0;
  int degenerate = 0;  // sweeps
  int rejected = 0;
  MatchReport report{};
};

Outcome drive(const std::vector<test::Wall>& walls, const Pose2d& step, const Pose2d& odometry_step,
              int steps, const Setting& setting = {}) {
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  const Pose2d map_T_start{0.3, 0.2, setting.map_yaw_start_rad};
  core.set_pose(map_T_start, {});
  Random random{5};
  Pose2d truth{};
  Pose2d odometry{};
  Outcome outcome;
  for (int i = 0; i < steps; ++i) {
    test::Scan scan;
    for (int k = 0; k < kBeams; ++k) {
      const double shift = setting.even_beams ? 0.0 : random.uniform_f64();
      const double bearing = 2.0 * std::numbers::pi * (k + shift) / kBeams;
      const double exact = test::cast(walls, truth.x_m, truth.y_m, truth.theta_rad + bearing);
      if (exact <= 0.0 || exact > kReach_m) { continue; }
      const double range = exact + 0.01 * random.gaussian();
      scan.x_m.push_back(static_cast<float>(range * std::cos(bearing)));
      scan.y_m.push_back(static_cast<float>(range * std::sin(bearing)));
    }
    UndistortedSweep sweep;
    sweep.odom_T_base = odometry;
    sweep.points = scan.view();
    EXPECT_EQ(core.process(sweep, true), Status::ok);
    if (i > 0 && !core.accepted()) { ++outcome.rejected; }
    if (i > 0 && core.report().outcome == MatchOutcome::degenerate) { ++outcome.degenerate; }
    if (i + 1 == steps) { break; }
    truth = truth * step;
    odometry = odometry * odometry_step;
  }
  const Pose2d pose = between(map_T_start, core.map_T_base());
  outcome.along_m = std::abs(pose.x_m - truth.x_m);
  outcome.across_m = std::abs(pose.y_m - truth.y_m);
  outcome.heading_rad = std::abs(wrap_angle(pose.theta_rad - truth.theta_rad));
  outcome.odometry_m = std::hypot(odometry.x_m - truth.x_m, odometry.y_m - truth.y_m);
  outcome.odometry_heading_rad = std::abs(wrap_angle(odometry.theta_rad - truth.theta_rad));
  outcome.report = core.report();
  return outcome;
}

// Oblique walls are stairs in the map, sparse hits single cells; neither may hold the vehicle back.
constexpr std::array kSettings{Setting{}, Setting{0.0, true}, Setting{0.4, false},
                               Setting{0.4, true}, Setting{0.785, true}};

TEST(Degeneracy, AlongAnEndlessCorridorTheOdometryIsKept) {
  // 10 m with odometry 1 % too short and turning by 0.1 deg a metre.
  for (const Setting& setting : kSettings) {
    const Outcome outcome =
        drive(test::endless_corridor(), {0.06, 0.0, 0.0}, {0.0594, 0.0, 1e-4}, 167, setting);
    EXPECT_GT(outcome.odometry_m, 0.1);
    EXPECT_LE(outcome.along_m, 0.01 * 10.0 + 0.01) << "not worse than plain odometry";
    EXPECT_LE(outcome.across_m, 0.05);
    EXPECT_LE(outcome.heading_rad, 0.005);
    EXPECT_GE(outcome.degenerate, 160);
    EXPECT_EQ(outcome.report.open_directions, 1);
    EXPECT_EQ(outcome.rejected, 0);
  }
}

/// Sweep after sweep shows a little more of a ragged wall, such as shelves or door frames: corners
/// that lie next to what is known already, and are not it.
TEST(Degeneracy, NewCornersInACorridorDoNotDragAStandingVehicle) {
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  core.set_pose({}, {});
  Random random{5};
  constexpr int kSweeps = 30;
  double worst_m = 0.0;
  for (int i = 0; i < kSweeps; ++i) {
    test::Scan scan;
    const auto add = [&](double x_m, double y_m) {
      scan.x_m.push_back(static_cast<float>(x_m + 0.01 * random.gaussian()));
      scan.y_m.push_back(static_cast<float>(y_m + 0.01 * random.gaussian()));
    };
    for (int k = 0; k < 80; ++k) { add(-4.0 + 0.1 * k, 1.025); }
    for (int k = 0; k < 80; ++k) { add(4.0 - 0.1 * k, -1.025); }
    constexpr double kShown_m = 0.24;  // a sweep
    for (double x = 4.1; x < 4.1 + kShown_m * i; x += 0.04) {
      add(x, std::fmod(x, 0.24) < 0.12 ? -1.0 : -1.2);
    }
    UndistortedSweep sweep;
    sweep.points = scan.view();
    ASSERT_EQ(core.process(sweep, true), Status::ok);
    ASSERT_TRUE(core.accepted());
    worst_m = std::max(worst_m, std::abs(core.map_T_base().x_m));
  }
  EXPECT_LE(worst_m, 0.2) << "over 6 m of them; those within the inlier distance still pull";
}

TEST(Degeneracy, AlongASingleWallTheOdometryIsKept) {
  for (const Setting& setting : kSettings) {
    const Outcome outcome =
        drive({{-500.0, 1.5, 500.0, 1.5}}, {0.06, 0.0, 0.0}, {0.0594, 0.0, 1e-4}, 167, setting);
    EXPECT_LE(outcome.along_m, 0.01 * 10.0 + 0.01);
    EXPECT_LE(outcome.across_m, 0.05);
    EXPECT_LE(outcome.heading_rad, 0.005);
    EXPECT_GE(outcome.degenerate, 160);
    EXPECT_EQ(outcome.report.open_directions, 1);
  }
}

TEST(Degeneracy, InTheMiddleOfACircleTheOdometryTurns) {
  // A full turn, odometry 1 % too far.
  const Outcome outcome = drive(round_room(3.0), {0.0, 0.0, 0.05}, {0.0, 0.0, 0.0505}, 126);
  EXPECT_LE(outcome.along_m, 0.02);
  EXPECT_LE(outcome.across_m, 0.02);
  EXPECT_LE(outcome.heading_rad, outcome.odometry_heading_rad + 0.01);
  EXPECT_GE(outcome.degenerate, 60) << "noise makes the circle a little rough";
}

TEST(Degeneracy, InOpenSpaceOdometryIsAllThereIs) {
  const Outcome outcome = drive({}, {0.06, 0.0, 0.0}, {0.0594, 0.0, 0.0}, 50);
  EXPECT_NEAR(outcome.along_m, outcome.odometry_m, 1e-9);
  EXPECT_EQ(outcome.rejected, 49);
  EXPECT_EQ(outcome.report.outcome, MatchOutcome::too_few_points);
}

TEST(Degeneracy, ARoomIsNone) {
  const Outcome outcome =
      drive(test::furnished_room(), {0.01, 0.0, 0.02}, {0.0099, 0.0, 0.0204}, 200);
  EXPECT_EQ(outcome.degenerate, 0);
  EXPECT_LE(std::hypot(outcome.along_m, outcome.across_m), 0.03);
  EXPECT_LE(outcome.heading_rad, 0.01);
}

/// Of the pose across a wall of that angle against the cells, and of its heading, in a map that
/// knows the wall's cells only; a sweep without noise.
struct WallSigma {
  float across_m = 0.0F;
  float heading_rad = 0.0F;
};
WallSigma sigma_beside_wall(double angle_rad) {
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  RollingMapCore& map = core.restorable_map();
  map.reset(0.0, 0.0);
  const GridWindow window = map.window();
  std::vector<std::int8_t> cells(map.occupancy().size(), map.config().low);
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  const auto cell_m = static_cast<double>(map.config().cell_m);
  test::Scan scan;
  for (double along_m = -8.0; along_m < 8.0; along_m += 0.01) {
    const double x_m = c * along_m - s * 1.5;
    const double y_m = s * along_m + c * 1.5;
    const auto column = static_cast<std::size_t>(std::floor(x_m / cell_m) - window.origin_x_cells);
    const auto row = static_cast<std::size_t>(std::floor(y_m / cell_m) - window.origin_y_cells);
    cells[row * static_cast<std::size_t>(window.width) + column] = map.config().high;
  }
  for (int k = -79; k <= 79; ++k) {
    const double along_m = 1.5 * std::tan(k * std::numbers::pi / 180.0);
    scan.x_m.push_back(static_cast<float>(c * along_m - s * 1.5));
    scan.y_m.push_back(static_cast<float>(s * along_m + c * 1.5));
  }
  for (int row = 0; row < window.height; ++row) {
    map.restore(0, row,
                std::span{cells}.subspan(static_cast<std::size_t>(row * window.width),
                                         static_cast<std::size_t>(window.width)));
  }
  EXPECT_EQ(core.localise_in_restored_map(), Status::ok);
  core.set_pose({}, {});
  UndistortedSweep sweep;
  sweep.points = scan.view();
  EXPECT_EQ(core.process(sweep, true), Status::ok);
  EXPECT_TRUE(core.accepted());
  const Matrix3f p = core.match_covariance();
  const auto x = static_cast<float>(-s);
  const auto y = static_cast<float>(c);
  return {std::sqrt(x * x * p(0, 0) + 2.0F * x * y * p(0, 1) + y * y * p(1, 1)),
          std::sqrt(p(2, 2))};
}

TEST(Degeneracy, AWallThatMeetsItsCellsInTheSameWayAgainAndAgainIsUncertainAsAWhole) {
  // Lines of cells lie 1 / |(h, k)| cells of 8 cm apart; the wall is anywhere between two.
  const WallSigma uneven = sigma_beside_wall(0.55);
  EXPECT_LT(uneven.across_m, 0.004F);
  EXPECT_NEAR(sigma_beside_wall(0.0).across_m, 0.08 / std::sqrt(12.0), 0.004);
  const double half_m = sigma_beside_wall(std::atan(0.5)).across_m;
  EXPECT_GT(half_m, 0.5 * 0.08 / std::sqrt(12.0 * 5.0));
  EXPECT_LT(half_m, 0.08 / std::sqrt(12.0 * 5.0)) << "interpolation takes some of it";
  // A step or two in sight turn the vehicle.
  EXPECT_GT(sigma_beside_wall(0.01).heading_rad, 2.0F * uneven.heading_rad);
}

}  // namespace
}  // namespace picolo
