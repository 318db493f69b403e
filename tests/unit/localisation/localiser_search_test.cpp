// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Where Gauss-Newton alone would be lost: long hops between scans, a glitch of the odometry, no
// odometry at all.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "picolo/geometry/angle.hpp"
#include "picolo/localisation/localiser.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

UndistortedSweep sweep_of(const test::Scan& scan, const Pose2d& odom_T_base) {
  UndistortedSweep sweep;
  sweep.odom_T_base = odom_T_base;
  sweep.points = scan.view();
  return sweep;
}

/// A localiser that has seen the room from all around and stands at the origin.
std::unique_ptr<Localiser<RoomProfile>> settled(const LocaliserConfig& config = {}) {
  auto localiser = std::make_unique<Localiser<RoomProfile>>(config);
  for (int i = 0; i < 20; ++i) {
    const Pose2d pose{0.05 * i - 0.05 * 19, 0.0, 0.33 * (i - 19)};
    const test::Scan scan = test::scan_at(test::furnished_room(), pose);
    if (i == 0) { localiser->core().set_pose(pose, pose); }
    EXPECT_EQ(localiser->core().process(sweep_of(scan, pose), true), Status::ok);
    EXPECT_TRUE(localiser->core().accepted());
  }
  return localiser;
}

void expect_at(const LocaliserCore& core, const Pose2d& truth) {
  EXPECT_TRUE(core.accepted());
  EXPECT_LE(std::hypot(core.map_T_base().x_m - truth.x_m, core.map_T_base().y_m - truth.y_m), 0.06);
  EXPECT_LE(std::abs(wrap_angle(core.map_T_base().theta_rad - truth.theta_rad)), 0.03);
}

TEST(LocaliserSearch, ALongHopWithABadPredictionIsFoundAndGaussNewtonAloneLosesIt) {
  const Pose2d truth{0.9, -0.6, 0.7};
  const Pose2d odometry{1.4, -1.05, 1.38};  // 0.67 m and 39 degrees off
  const test::Scan scan = test::scan_at(test::furnished_room(), truth);

  const auto with_search = settled();
  ASSERT_EQ(with_search->core().process(sweep_of(scan, odometry), true), Status::ok);
  expect_at(with_search->core(), truth);
  EXPECT_EQ(with_search->core().counters().searched, 1U + 19U) << "the settling turns are hops too";

  LocaliserConfig alone;
  alone.search.enabled = false;
  const auto without = settled(alone);
  ASSERT_EQ(without->core().process(sweep_of(scan, odometry), true), Status::ok);
  EXPECT_GT(std::hypot(without->core().map_T_base().x_m - truth.x_m,
                       without->core().map_T_base().y_m - truth.y_m),
            0.1);
}

TEST(LocaliserSearch, AGlitchOfTheOdometryIsCaughtByTheWideSearch) {
  const auto localiser = settled();
  const Pose2d truth{0.1, 0.1, 1.6};
  const test::Scan scan = test::scan_at(test::furnished_room(), truth);
  ASSERT_EQ(localiser->core().process(sweep_of(scan, {2.5, 1.5, -1.0}), true), Status::ok);
  EXPECT_EQ(localiser->core().counters().searched_wide, 1U);
  expect_at(localiser->core(), truth);
}

TEST(LocaliserSearch, WithoutOdometryFastMotionIsFollowed) {
  const auto localiser = settled();
  for (int i = 1; i <= 20; ++i) {
    const Pose2d truth{0.03 * i, -0.02 * i, 0.28 * i};
    const test::Scan scan = test::scan_at(test::furnished_room(), truth);
    ASSERT_EQ(localiser->core().process(sweep_of(scan, {}), false), Status::ok);
    expect_at(localiser->core(), {truth.x_m, truth.y_m, wrap_angle(truth.theta_rad)});
  }
}

TEST(LocaliserSearch, EverySliceIsBounded) {
  LocaliserConfig config;
  config.search.lookups_per_step = 500;
  const auto localiser = settled(config);
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.5, 0.2, 0.4});
  ASSERT_EQ(localiser->core().begin(sweep_of(scan, {0.5, 0.2, 0.4}), true), Status::ok);
  int slices = 0;
  while (!localiser->core().match_step()) { ++slices; }
  EXPECT_GT(slices, 50) << "a small bound makes many slices";
  expect_at(localiser->core(), {0.5, 0.2, 0.4});
}

}  // namespace
}  // namespace picolo
