// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The localiser in a small true world: it follows drifting odometry, refuses what does not fit, and
// gives the same bits whatever the slices.

#include "picolo/localisation/localiser.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/hash.hpp"
#include "picolo/core/random.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

/// A loop through the furnished room, in steps of about 5 cm and 2 degrees.
Pose2d truth_at(int step) {
  const double phase = 0.02 * step;
  return {1.2 * std::sin(phase), 0.9 * std::sin(2 * phase), phase};
}

struct Drive {
  std::vector<Pose2d> truth;
  std::vector<Pose2d> odometry;
  std::vector<test::Scan> scans;
};

/// Odometry that overestimates every turn by 5 % and every distance by 2 %.
Drive drive(int steps) {
  Drive result;
  Pose2d odometry = truth_at(0);
  for (int i = 0; i < steps; ++i) {
    const Pose2d truth = truth_at(i);
    if (i > 0) {
      Pose2d motion = between(result.truth.back(), truth);
      motion.x_m *= 1.02;
      motion.y_m *= 1.02;
      motion.theta_rad *= 1.05;
      odometry = odometry * motion;
    }
    result.truth.push_back(truth);
    result.odometry.push_back(odometry);
    result.scans.push_back(test::scan_at(test::furnished_room(), truth));
  }
  return result;
}

UndistortedSweep sweep_of(const Drive& drive, std::size_t i) {
  UndistortedSweep sweep;
  sweep.reference = Timestamp{Duration{static_cast<std::int64_t>(i) * 100'000}};
  sweep.odom_T_base = drive.odometry[i];
  sweep.points = drive.scans[i].view();
  return sweep;
}

double distance(const Pose2d& a, const Pose2d& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

TEST(Localiser, TracksTheTruthThroughDriftingOdometry) {
  const Drive world = drive(300);
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  core.set_pose(world.truth[0], world.odometry[0]);
  double worst_m = 0.0;
  for (std::size_t i = 0; i < world.truth.size(); ++i) {
    ASSERT_EQ(core.process(sweep_of(world, i), true), Status::ok);
    ASSERT_TRUE(core.accepted());
    worst_m = std::max(worst_m, distance(core.map_T_base(), world.truth[i]));
  }
  EXPECT_GT(distance(world.odometry.back(), world.truth.back()), 0.15)
      << "the odometry alone is lost";
  EXPECT_LE(worst_m, 0.05);
  EXPECT_EQ(core.counters().sweeps, 300U);
  EXPECT_EQ(core.counters().matched, 299U);
  const Pose2d published = core.map_T_odom() * world.odometry.back();
  EXPECT_LE(distance(published, core.map_T_base()), 1e-9);
}

TEST(Localiser, TracksWithoutOdometry) {
  const Drive world = drive(300);
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  core.set_pose(world.truth[0], Pose2d{});
  for (std::size_t i = 0; i < world.truth.size(); ++i) {
    UndistortedSweep sweep = sweep_of(world, i);
    sweep.odom_T_base = {};
    ASSERT_EQ(core.process(sweep, false), Status::ok);
  }
  EXPECT_LE(distance(core.map_T_base(), world.truth.back()), 0.06);
}

/// Where a vehicle that stands still believes to be, relative to where its map was founded.
Pose2d settled(const Pose2d& truth, Random& random) {
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  for (int i = 0; i < 15; ++i) {
    test::Scan scan = test::scan_at(test::furnished_room(), truth);
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
      const float range_m = std::hypot(scan.x_m[k], scan.y_m[k]);
      const float noise = 1.0F + static_cast<float>(0.01 * random.gaussian()) / range_m;
      scan.x_m[k] *= noise;
      scan.y_m[k] *= noise;
    }
    UndistortedSweep sweep;
    sweep.points = scan.view();
    EXPECT_EQ(core.process(sweep, true), Status::ok);
  }
  return core.map_T_base();
}

TEST(Localiser, GivenAnyHeadingThenTheGridDrawsThePoseNowhere) {
  Random random{7};
  constexpr int kPlaces = 40;
  double x_m = 0.0, y_m = 0.0, squares = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const Pose2d pose =
        settled({random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-3.14, 3.14)},
                random);
    x_m += pose.x_m / kPlaces;
    y_m += pose.y_m / kPlaces;
    squares += (pose.x_m * pose.x_m + pose.y_m * pose.y_m) / kPlaces;
  }
  EXPECT_LT(std::hypot(x_m, y_m), 0.003) << "no direction is preferred";
  EXPECT_LT(std::sqrt(squares), 0.010) << "cells of 8 cm";
}

std::uint64_t hash_of(const LocaliserCore& core, const std::vector<Pose2d>& poses) {
  Hash hash;
  for (const Pose2d& pose : poses) {
    hash.add(pose.x_m);
    hash.add(pose.y_m);
    hash.add(pose.theta_rad);
  }
  for (const std::int8_t cell : core.map().occupancy()) {
    hash.add(static_cast<std::uint32_t>(cell + 128));
  }
  EXPECT_FALSE(hash.poisoned());
  return hash.value();
}

TEST(Localiser, SlicesOfAnySizeGiveTheSameBits) {
  const Drive world = drive(40);
  std::vector<std::uint64_t> hashes;
  for (const std::size_t rays :
       {std::size_t{4096}, std::size_t{1}, std::size_t{37}, std::size_t{128}}) {
    auto localiser = std::make_unique<Localiser<RoomProfile>>();
    LocaliserCore& core = localiser->core();
    std::vector<Pose2d> poses;
    for (std::size_t i = 0; i < world.truth.size(); ++i) {
      ASSERT_EQ(core.begin(sweep_of(world, i), true), Status::ok);
      while (!core.match_step()) {}
      while (!core.map_step(rays)) {}
      EXPECT_EQ(core.phase(), LocaliserPhase::idle);
      poses.push_back(core.map_T_base());
    }
    hashes.push_back(hash_of(core, poses));
  }
  for (const std::uint64_t hash : hashes) { EXPECT_EQ(hash, hashes.front()); }
}

TEST(Localiser, ASecondSweepMustWaitForTheFirst) {
  const Drive world = drive(2);
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  ASSERT_EQ(localiser->core().begin(sweep_of(world, 0), true), Status::ok);
  EXPECT_EQ(localiser->core().begin(sweep_of(world, 1), true), Status::invalid_argument);
}

TEST(Localiser, AScanThatDoesNotFitMovesNothing) {
  const Drive world = drive(60);
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  core.set_pose(world.truth[0], world.odometry[0]);
  for (std::size_t i = 0; i < 50; ++i) {
    ASSERT_EQ(core.process(sweep_of(world, i), true), Status::ok);
  }
  const std::vector<std::int8_t> map_before(core.map().occupancy().begin(),
                                            core.map().occupancy().end());
  const Pose2d map_T_odom = core.map_T_odom();

  test::Scan noise;  // a ring of points all over the room
  Random random{8};
  for (int k = 0; k < 360; ++k) {
    noise.x_m.push_back(static_cast<float>(random.uniform(-2.5, 2.5)));
    noise.y_m.push_back(static_cast<float>(random.uniform(-2.5, 2.5)));
  }
  UndistortedSweep sweep = sweep_of(world, 50);
  sweep.points = noise.view();
  ASSERT_EQ(core.process(sweep, true), Status::ok);
  EXPECT_FALSE(core.accepted());
  EXPECT_EQ(core.counters().rejected, 1U);
  EXPECT_EQ(core.map_T_odom(), map_T_odom);
  EXPECT_TRUE(std::equal(map_before.begin(), map_before.end(), core.map().occupancy().begin()));
  EXPECT_LE(distance(core.map_T_base(), map_T_odom * world.odometry[50]), 1e-4)
      << "odometry carries on, its heading corrected by what was learnt";

  ASSERT_EQ(core.process(sweep_of(world, 51), true), Status::ok);
  EXPECT_TRUE(core.accepted());
  EXPECT_LE(distance(core.map_T_base(), world.truth[51]), 0.05);
}

TEST(Localiser, AnEmptySweepIsRejectedNotFatal) {
  const Drive world = drive(5);
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  ASSERT_EQ(core.process(sweep_of(world, 0), true), Status::ok);
  UndistortedSweep sweep = sweep_of(world, 1);
  sweep.points = {};
  ASSERT_EQ(core.process(sweep, true), Status::ok);
  EXPECT_FALSE(core.accepted());
  EXPECT_EQ(core.report().outcome, MatchOutcome::too_few_points);
}

TEST(Localiser, TheWindowFollowsAlongAHallAndTheMapFrameStays) {
  // A hall longer than the window, with pillars that constrain the way along.
  std::vector<test::Wall> hall{{-5, -2, 60, -2}, {-5, 2, 60, 2}, {-5, -2, -5, 2}, {60, -2, 60, 2}};
  for (double x = -3.3; x < 59; x += 1.7) {
    hall.push_back({x, -2, x, -1.6});
    hall.push_back({x, -1.6, x + 0.4, -1.6});
    hall.push_back({x + 0.4, -1.6, x + 0.4, -2});
  }
  auto localiser = std::make_unique<Localiser<RoomProfile>>();
  LocaliserCore& core = localiser->core();
  double worst_m = 0.0;
  for (int i = 0; i <= 250; ++i) {
    const Pose2d truth{0.2 * i, 0.3 * std::sin(0.1 * i), 0.1 * std::cos(0.07 * i)};
    const test::Scan scan = test::scan_at(hall, truth, 720);
    if (i == 0) { core.set_pose(truth, truth); }
    UndistortedSweep sweep;
    sweep.odom_T_base = {truth.x_m * 1.01, truth.y_m, truth.theta_rad};
    sweep.points = scan.view();
    ASSERT_EQ(core.process(sweep, true), Status::ok);
    ASSERT_TRUE(core.accepted()) << "step " << i;
    worst_m = std::max(worst_m, distance(core.map_T_base(), truth));
  }
  EXPECT_GT(core.map().window().origin_x_cells, 200);
  EXPECT_LE(worst_m, 0.15) << "30 window widths without a loop, odometry 0.5 m off at the end";
}

TEST(LocaliserConfig, RefusesWhatCannotWork) {
  EXPECT_TRUE(LocaliserConfig{}.valid());
  EXPECT_FALSE((LocaliserConfig{.min_inlier_share = 1.5F}).valid());
  EXPECT_FALSE((LocaliserConfig{.max_repair_tiles = 0}).valid());
  LocaliserConfig config;
  config.fine.max_iterations = 0;
  EXPECT_FALSE(config.valid());
  auto localiser = std::make_unique<Localiser<RoomProfile>>(config);
  EXPECT_EQ(localiser->core().begin({}, true), Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
