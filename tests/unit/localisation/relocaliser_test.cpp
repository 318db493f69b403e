// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A vehicle that may be anywhere in its map: found in slices, and only where nothing else fits.

#include "picolo/localisation/relocaliser.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/localisation/localiser.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

using test::furnished_room;
using test::scan_at;
using test::Wall;

UndistortedSweep sweep_of(const test::Scan& scan, const Pose2d& odom_T_base) {
  UndistortedSweep sweep;
  sweep.odom_T_base = odom_T_base;
  sweep.points = scan.view();
  return sweep;
}

/// A localiser that has driven a round in the room, then lost its way.
std::unique_ptr<Localiser<RoomProfile>> lost_in(const std::vector<Wall>& walls,
                                                const LocaliserConfig& config = {}) {
  auto localiser = std::make_unique<Localiser<RoomProfile>>(config);
  LocaliserCore& core = localiser->core();
  for (int i = 0; i < 30; ++i) {
    const double angle = 0.21 * i;
    const Pose2d pose{1.5 * std::cos(angle), 1.2 * std::sin(angle), wrap_angle(angle)};
    if (i == 0) { core.set_pose(pose, pose); }
    EXPECT_EQ(core.process(sweep_of(scan_at(walls, pose), pose), true), Status::ok);
    EXPECT_TRUE(core.accepted());
  }
  core.hold_map(true);
  core.doubt(true);
  return localiser;
}

double distance(const Pose2d& a, const Pose2d& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

TEST(Relocaliser, GivenAKidnappedVehicleThenItIsFoundWhereverItIsAndAgreesWithTheMap) {
  const auto localiser = lost_in(furnished_room());
  LocaliserCore& core = localiser->core();
  Random random{5};
  for (int k = 0; k < 12; ++k) {
    const Pose2d truth{random.uniform(-3.0F, 1.5F), random.uniform(-2.2F, 1.8F),
                       random.uniform(-3.1F, 3.1F)};
    const test::Scan scan = scan_at(furnished_room(), truth);
    core.verify(false);
    ASSERT_EQ(core.process(sweep_of(scan, {}), true), Status::ok);
    EXPECT_FALSE(core.unverified());
    EXPECT_TRUE(core.accepted());
    EXPECT_LT(distance(core.map_T_base(), truth), 0.05) << k;
    EXPECT_LT(std::abs(wrap_angle(core.map_T_base().theta_rad - truth.theta_rad)), 0.02) << k;
    EXPECT_GT(core.agreement(), 0.9F);
  }
  EXPECT_EQ(core.counters().searched_anywhere, 12U);
  EXPECT_GE(core.counters().found_anywhere, 8U) << "the others were near enough to stay";
}

TEST(Relocaliser, GivenTwoPlacesThatLookAlikeThenNeitherIsTaken) {
  const std::vector<Wall> hall{{-4, -3, 4, -3}, {4, -3, 4, 3}, {4, 3, -4, 3}, {-4, 3, -4, -3}};
  const auto localiser = lost_in(hall);
  LocaliserCore& core = localiser->core();
  const Pose2d truth{-2.4, -1.6, 2.0};
  core.verify(false);
  for (std::uint32_t k = 1; k < 4; ++k) {
    ASSERT_EQ(core.process(sweep_of(scan_at(hall, truth), {}), true), Status::ok);
    EXPECT_EQ(core.counters().searched_anywhere, k);
    EXPECT_TRUE(core.ambiguous());
    EXPECT_TRUE(core.unverified());
    EXPECT_EQ(core.agreement(), 0.0F) << "however well it fits";
  }
  EXPECT_EQ(core.counters().found_anywhere, 0U);
  // Somebody who knows says which of the two it is.
  core.set_pose({-2.3, -1.7, 2.05}, {});
  ASSERT_EQ(core.process(sweep_of(scan_at(hall, truth), {}), true), Status::ok);
  EXPECT_FALSE(core.unverified());
  EXPECT_LT(distance(core.map_T_base(), truth), 0.05);
}

TEST(Relocaliser, GivenAWrongStartThatLooksAlmostRightThenTheBetterPlaceIsTaken) {
  const auto localiser = lost_in(furnished_room());
  LocaliserCore& core = localiser->core();
  const Pose2d truth{-2.4, -1.6, 2.0};
  const Pose2d mirrored{2.4, 1.6, 2.0 - 3.14159};  // the room turned by half a circle
  const test::Scan scan = scan_at(furnished_room(), truth);
  core.set_pose(mirrored, {});
  ASSERT_EQ(core.process(sweep_of(scan, {}), true), Status::ok);
  EXPECT_LT(distance(core.map_T_base(), truth), 0.05);
}

TEST(Relocaliser, GivenSurroundingsThatAreNotInTheMapThenNothingIsFound) {
  const auto localiser = lost_in(furnished_room());
  LocaliserCore& core = localiser->core();
  const std::vector<Wall> elsewhere{
      {-1, -9, 2, -8}, {2, -8, 6, 4}, {6, 4, -1, 7}, {-1, 7, -6, 1}, {-6, 1, -1, -9}};
  for (int k = 0; k < 6; ++k) {
    ASSERT_EQ(core.process(sweep_of(scan_at(elsewhere, {}), {}), true), Status::ok);
    EXPECT_LT(core.agreement(), 0.85F);
  }
  EXPECT_EQ(core.counters().searched_anywhere, 4U) << "from the third sweep on, until it is found";
  EXPECT_TRUE(core.unverified());
  EXPECT_EQ(core.counters().found_anywhere, 0U);
}

TEST(Relocaliser, GivenSlicesThenEachIsShortAndTheMapIsWholeAfterwards) {
  const auto localiser = lost_in(furnished_room());
  LocaliserCore& core = localiser->core();
  const Pose2d truth{-2.5, 1.0, -2.0};
  const test::Scan scan = scan_at(furnished_room(), truth);
  int slices = 0;
  core.verify(false);
  ASSERT_EQ(core.begin(sweep_of(scan, {}), true), Status::ok);
  while (!core.match_step()) { slices += core.relocalising() ? 1 : 0; }
  EXPECT_EQ(core.counters().found_anywhere, 1U);
  EXPECT_GT(slices, 500);
  EXPECT_LT(distance(core.map_T_base(), truth), 0.05);
  // The memory that the search borrowed is the map's again.
  core.hold_map(false);
  core.doubt(false);
  const std::uint32_t inserted = core.counters().inserted;
  ASSERT_EQ(core.process(sweep_of(scan, {}), true), Status::ok);
  EXPECT_EQ(core.counters().inserted, inserted + 1);
  EXPECT_GT(core.report().inlier_share, 0.9F);
}

Pose2d after(int steps) {
  const double angle = 0.05 * steps;
  return {1.5 * std::cos(angle), 1.2 * std::sin(angle), wrap_angle(angle)};
}

TEST(Relocaliser, GivenALargeMapThenAWayThatAgreesProvesThePoseWithoutASearch) {
  LocaliserConfig config;
  config.relocalise.longest_search_m = 2.0F;
  const auto localiser = lost_in(furnished_room(), config);
  LocaliserCore& core = localiser->core();
  core.verify(false);
  double way_m = 0.0;
  for (int k = 1; core.unverified() && k < 100; ++k) {
    const Pose2d pose = after(k);
    ASSERT_EQ(core.process(sweep_of(scan_at(furnished_room(), pose), pose), true), Status::ok);
    ASSERT_TRUE(core.accepted());
    way_m += k > 1 ? distance(after(k - 1), pose) : 0.0;
  }
  EXPECT_FALSE(core.unverified());
  EXPECT_GT(way_m, LocaliserConfig{}.relocalise.proof_way_m - 0.5F);
  EXPECT_LT(way_m, LocaliserConfig{}.relocalise.proof_way_m + 0.5F);
  EXPECT_EQ(core.counters().searched_anywhere, 0U);
}

TEST(Relocaliser, GivenALargeMapThenWhatFitsBadlyIsSearchedForAndWhatFitsHalfwayIsNot) {
  const std::vector<Wall> elsewhere{
      {-1, -9, 2, -8}, {2, -8, 6, 4}, {6, 4, -1, 7}, {-1, 7, -6, 1}, {-6, 1, -1, -9}};
  std::vector<Wall> changed = furnished_room();
  changed.push_back({-0.6, -1.0, 0.6, -1.0});  // somebody stands there
  for (const auto& [walls, searched] : {std::pair{elsewhere, true}, std::pair{changed, false}}) {
    LocaliserConfig config;
    config.relocalise.longest_search_m = 2.0F;
    const auto localiser = lost_in(furnished_room(), config);
    LocaliserCore& core = localiser->core();
    core.verify(false);
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(core.process(sweep_of(scan_at(walls, {}), {}), true), Status::ok);
    }
    EXPECT_LT(core.agreement(), 0.85F);
    EXPECT_TRUE(core.unverified());
    EXPECT_EQ(core.counters().searched_anywhere > 0U, searched);
  }
}

TEST(Relocaliser, GivenFewPointsOrNoDoubtThenTheWholeMapIsNotSearched) {
  const auto localiser = lost_in(furnished_room());
  LocaliserCore& core = localiser->core();
  const test::Scan few = scan_at(furnished_room(), {-2.5, 1.0, -2.0}, 50);
  for (int k = 0; k < 4; ++k) { ASSERT_EQ(core.process(sweep_of(few, {}), true), Status::ok); }
  core.doubt(false);
  const test::Scan scan = scan_at(furnished_room(), {-2.5, 1.0, -2.0});
  for (int k = 0; k < 4; ++k) { ASSERT_EQ(core.process(sweep_of(scan, {}), true), Status::ok); }
  EXPECT_EQ(core.counters().searched_anywhere, 0U);
}

}  // namespace
}  // namespace picolo
