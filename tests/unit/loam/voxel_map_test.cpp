// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/voxel_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

using Map = VoxelMap<512, 8, 256>;

Vector3f random_point(Random& random, float reach) {
  const auto at = [&] { return static_cast<float>(random.uniform(-reach, reach)); };
  const float x = at();
  const float y = at();
  const float z = at();
  return {x, y, z};
}

float squared(const Vector3f& a, const Vector3f& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
}

TEST(VoxelMap, GivenRandomPointsThenNearestAgreesWithTryingAll) {
  Map map{{.voxel_m = 1.0F, .spacing_m = 0.0F}};
  Random random{1};
  std::vector<Vector3f> stored;
  while (stored.size() < 400) {
    const Vector3f p = random_point(random, 3.0F);
    if (map.core().insert(p)) { stored.push_back(p); }
  }
  for (int i = 0; i < 500; ++i) {
    const Vector3f q = random_point(random, 4.0F);
    std::vector<float> wanted;
    for (const auto& p : stored) {
      if (squared(p, q) < 0.8F * 0.8F) { wanted.push_back(squared(p, q)); }
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.resize(std::min<std::size_t>(wanted.size(), 5));
    std::array<Neighbour, 5> found;
    const std::size_t count = map.core().nearest(q, 0.8F, found);
    ASSERT_EQ(count, wanted.size());
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_NEAR(found[k].squared_m2, wanted[k], 1e-4F);
      EXPECT_NEAR(squared(found[k].point_m, q), found[k].squared_m2, 1e-6F);
    }
  }
}

TEST(VoxelMap, GivenPointsCloserThanTheSpacingThenTheyAreAveraged) {
  Map map{{.voxel_m = 1.0F, .spacing_m = 0.3F, .max_weight = 10}};
  for (const float x : {0.40F, 0.50F, 0.60F}) { EXPECT_TRUE(map.core().insert({x, 0.5F, 0.5F})); }
  std::array<Neighbour, 3> found;
  ASSERT_EQ(map.core().nearest({0.5F, 0.5F, 0.5F}, 1.0F, found), 1U);
  EXPECT_NEAR(found[0].point_m.x, 0.5F, 1e-4F);
  EXPECT_EQ(map.core().counters().inserted, 1U);
  EXPECT_EQ(map.core().counters().averaged, 2U);
}

TEST(VoxelMap, GivenAMovedAnchorThenTheSamePlacesAreFoundInNewCoordinates) {
  Map map{{}};
  ASSERT_TRUE(map.core().insert({12.3F, -4.5F, 0.6F}));
  map.core().set_anchor({10, -5, 1});
  std::array<Neighbour, 1> found;
  ASSERT_EQ(map.core().nearest({2.3F, 0.5F, -0.4F}, 0.5F, found), 1U);
  EXPECT_NEAR(found[0].point_m.x, 2.3F, 1e-4F);
  EXPECT_NEAR(found[0].point_m.y, 0.5F, 1e-4F);
  EXPECT_NEAR(found[0].point_m.z, -0.4F, 1e-4F);
  std::array<Vector3d, 8> points;
  for (std::size_t i = 0; i < map.core().capacity(); ++i) {
    if (map.core().points_of(i, points) == 1) { EXPECT_NEAR(points[0].x, 12.3, 1e-4); }
  }
}

TEST(VoxelMap, GivenMoreThanItHoldsThenItRefusesAndCounts) {
  VoxelMap<4, 2, 4> map{{.spacing_m = 0.0F}};
  for (int i = 0; i < 6; ++i) {
    (void)map.core().insert({static_cast<float>(i) + 0.5F, 0.5F, 0.5F});
  }
  EXPECT_EQ(map.core().voxels(), 4U);
  EXPECT_EQ(map.core().counters().refused, 2U);
  EXPECT_TRUE(map.core().insert({0.1F, 0.1F, 0.1F}));
  EXPECT_FALSE(map.core().insert({0.2F, 0.2F, 0.2F}));
  EXPECT_EQ(map.core().counters().crowded, 1U);
  EXPECT_FALSE(map.core().insert({1e9F, 0, 0}));
  EXPECT_FALSE(map.core().insert({std::nanf(""), 0, 0}));
}

TEST(VoxelMap, GivenPruningThenCubesLeftBehindAreFreedAndReused) {
  VoxelMap<64, 2, 16> map{{.spacing_m = 0.0F}};
  for (int i = 0; i < 64; ++i) {
    ASSERT_TRUE(map.core().insert({static_cast<float>(i) + 0.5F, 0.5F, 0.5F}));
  }
  map.core().set_anchor({60, 0, 0});
  for (int i = 0; i < 16; ++i) { map.core().prune(10.0F, 4); }
  EXPECT_EQ(map.core().voxels(), 14U);  // cubes 50 .. 63
  std::array<Neighbour, 1> found;
  EXPECT_EQ(map.core().nearest({-59.5F, 0.5F, 0.5F}, 0.4F, found), 0U);
  EXPECT_EQ(map.core().nearest({-9.5F, 0.5F, 0.5F}, 0.4F, found), 1U);
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(map.core().insert({static_cast<float>(i) + 5.5F, 0.5F, 0.5F}));
  }
  EXPECT_EQ(map.core().voxels(), 64U);
}

TEST(VoxelMap, GivenALongDriveThenEveryCubeIsAccountedFor) {
  auto map = std::make_unique<Map>(VoxelMapConfig{});
  Random random{4};
  for (int step = 0; step < 400; ++step) {
    const auto ahead = static_cast<std::int16_t>(step);
    map->core().set_anchor({ahead, static_cast<std::int16_t>(-ahead), 0});
    for (int i = 0; i < 40; ++i) { (void)map->core().insert(random_point(random, 3.0F)); }
    map->core().prune(5.0F, 512);
  }
  std::size_t used = 0;
  std::array<Vector3d, 8> points;
  for (std::size_t i = 0; i < map->core().capacity(); ++i) {
    const std::size_t count = map->core().points_of(i, points);
    used += count > 0 ? 1 : 0;
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_LT(std::hypot(points[k].x - 399.5, points[k].y + 398.5), 8.0);
    }
  }
  EXPECT_EQ(used, map->core().voxels());
  EXPECT_EQ(map->core().counters().refused, 0U);
  map->core().clear();
  EXPECT_EQ(map->core().voxels(), 0U);
}

}  // namespace
}  // namespace picolo
