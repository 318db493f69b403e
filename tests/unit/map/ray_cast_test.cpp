// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Expected ranges in small maps.

#include "picolo/map/ray_cast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace picolo {
namespace {

using Map = RollingMap<64, 48>;  // 3.2 m x 2.4 m

std::unique_ptr<Map> with_column(int column) {
  auto map = std::make_unique<Map>();
  map->core().begin_scan();
  for (int row = 0; row < 48; ++row) {
    map->core().add_hit(
        {0.05F * (static_cast<float>(column) + 0.5F), 0.05F * (static_cast<float>(row) + 0.5F)});
  }
  return map;
}

TEST(RayCast, GivenAWallAheadThenTheRangeEndsInItsCell) {
  const auto map = with_column(40);  // from 2.00 m to 2.05 m
  const Pose2f lidar{0.52F, 1.21F, 0.0F};
  const ExpectedRange straight = cast_ray(map->core(), lidar, 0.0F, 10.0F);
  ASSERT_TRUE(straight.met_obstacle);
  EXPECT_NEAR(straight.range_m, 2.025F - 0.52F, 1e-4F);
  for (const float bearing : {0.3F, -0.35F, 0.6F}) {
    const ExpectedRange range = cast_ray(map->core(), lidar, bearing, 10.0F);
    ASSERT_TRUE(range.met_obstacle) << bearing;
    EXPECT_NEAR(range.range_m * std::cos(bearing), 2.025F - 0.52F, 0.026F) << bearing;
  }
}

TEST(RayCast, GivenTheOtherDirectionsThenSignsAndYawHold) {
  const auto map = with_column(10);  // 0.50 m to 0.55 m
  EXPECT_NEAR(cast_ray(map->core(), {2.0F, 1.2F, 0.0F}, 3.14159265F, 10.0F).range_m, 1.475F, 1e-3F);
  EXPECT_NEAR(cast_ray(map->core(), {2.0F, 1.2F, 3.14159265F}, 0.0F, 10.0F).range_m, 1.475F, 1e-3F);
  EXPECT_NEAR(cast_ray(map->core(), {2.0F, 1.2F, -2.0F}, 2.0F - 3.14159265F, 10.0F).range_m, 1.475F,
              1e-3F);
  EXPECT_FALSE(cast_ray(map->core(), {2.0F, 1.2F, 0.0F}, 0.0F, 10.0F).met_obstacle);
  EXPECT_FALSE(cast_ray(map->core(), {2.0F, 1.2F, 0.0F}, 1.5707963F, 10.0F).met_obstacle);
}

TEST(RayCast, GivenAWallBeyondTheMaximumThenNothingIsMet) {
  const auto map = with_column(40);
  EXPECT_FALSE(cast_ray(map->core(), {0.52F, 1.21F, 0.0F}, 0.0F, 1.4F).met_obstacle);
  EXPECT_TRUE(cast_ray(map->core(), {0.52F, 1.21F, 0.0F}, 0.0F, 1.6F).met_obstacle);
}

TEST(RayCast, GivenUnknownCellsOnTheWayThenItSaysSo) {
  const auto map = with_column(40);
  const Pose2f lidar{0.52F, 1.21F, 0.0F};
  EXPECT_TRUE(cast_ray(map->core(), lidar, 0.0F, 10.0F).saw_unknown);
  map->core().begin_scan();
  map->core().add_ray({0.52F, 1.21F}, {2.02F, 1.21F}, 0);
  EXPECT_FALSE(cast_ray(map->core(), lidar, 0.0F, 10.0F).saw_unknown);
}

TEST(RayCast, GivenALidarOutsideOrNowhereThenNothingIsMetAndTheWalkEnds) {
  const auto map = with_column(40);
  const float nan = std::nanf("");
  for (const Pose2f lidar : {Pose2f{-1.0F, 1.0F, 0.0F}, Pose2f{9.0F, 1.0F, 0.0F},
                             Pose2f{1.0F, 5.0F, 0.0F}, Pose2f{nan, 1.0F, 0.0F}}) {
    EXPECT_FALSE(cast_ray(map->core(), lidar, 0.0F, 10.0F).met_obstacle);
  }
  EXPECT_FALSE(cast_ray(map->core(), {1.0F, 1.0F, nan}, 0.0F, 10.0F).met_obstacle);
  const ExpectedRange inside = cast_ray(map->core(), {2.02F, 1.21F, 0.0F}, 0.0F, 10.0F);
  EXPECT_TRUE(inside.met_obstacle);
  EXPECT_LT(inside.range_m, 0.05F);
}

}  // namespace
}  // namespace picolo
