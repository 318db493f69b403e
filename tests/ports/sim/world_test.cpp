// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Rays against closed forms.

#include "picolo/sim/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "picolo/core/random.hpp"

namespace picolo::sim {
namespace {

constexpr double kPi = std::numbers::pi;

/// Distance from a point inside of the box [0, w] x [0, h] to its border.
double box_range(double x_m, double y_m, double bearing_rad, double w_m, double h_m) {
  const double c = std::cos(bearing_rad);
  const double s = std::sin(bearing_rad);
  const double to_x = c > 0 ? (w_m - x_m) / c : c < 0 ? -x_m / c : 1e9;
  const double to_y = s > 0 ? (h_m - y_m) / s : s < 0 ? -y_m / s : 1e9;
  return std::min(to_x, to_y);
}

TEST(World, GivenABoxThenEveryRayFromInsideHasTheClosedForm) {
  World world;
  ASSERT_TRUE(world.add_box({0, 0}, {7, 4}));
  Random random{1};
  for (int i = 0; i < 20'000; ++i) {
    const double x_m = random.uniform(0.01, 6.99);
    const double y_m = random.uniform(0.01, 3.99);
    const double bearing_rad = random.uniform(-kPi, kPi);
    EXPECT_NEAR(world.cast({x_m, y_m}, bearing_rad, 100.0), box_range(x_m, y_m, bearing_rad, 7, 4),
                1e-9);
  }
}

TEST(World, GivenARayIntoACornerThenItDoesNotEscape) {
  World world;
  ASSERT_TRUE(world.add_box({0, 0}, {7, 4}));
  Random random{2};
  for (int i = 0; i < 20'000; ++i) {
    const double x_m = random.uniform(0.01, 6.99);
    const double y_m = random.uniform(0.01, 3.99);
    for (const Point2d corner : {Point2d{0, 0}, Point2d{7, 0}, Point2d{7, 4}, Point2d{0, 4}}) {
      const double bearing_rad = std::atan2(corner.y_m - y_m, corner.x_m - x_m);
      EXPECT_NEAR(world.cast({x_m, y_m}, bearing_rad, 100.0),
                  std::hypot(corner.x_m - x_m, corner.y_m - y_m), 1e-6);
    }
  }
}

TEST(World, GivenAPolygonOfManyWallsThenTheRangeFromItsCentreIsThatOfTheChord) {
  constexpr int kSides = 100;
  World world;
  for (int i = 0; i < kSides; ++i) {
    const double a = 2 * kPi * i / kSides;
    const double b = 2 * kPi * (i + 1) / kSides;
    ASSERT_TRUE(
        world.add({{3 * std::cos(a), 3 * std::sin(a)}, {3 * std::cos(b), 3 * std::sin(b)}}));
  }
  for (int k = 0; k < 1000; ++k) {
    const double bearing_rad = -kPi + 2 * kPi * (k + 0.5) / 1000;
    const double inside = std::fmod(bearing_rad + 2 * kPi, 2 * kPi / kSides) - kPi / kSides;
    const double apothem_m = 3 * std::cos(kPi / kSides);
    EXPECT_NEAR(world.cast({0, 0}, bearing_rad, 10.0), apothem_m / std::cos(inside), 1e-9);
  }
}

TEST(World, GivenTwoWallsThenTheNearerIsSeenInWhicheverOrderTheyWereAdded) {
  World world;
  ASSERT_TRUE(world.add({{5, -1}, {5, 1}}));
  ASSERT_TRUE(world.add({{2, 1}, {2, -1}}));
  ASSERT_TRUE(world.add({{3, -1}, {3, 1}}));
  EXPECT_DOUBLE_EQ(world.cast({0, 0}, 0.0, 10.0), 2.0);
}

TEST(World, GivenNothingInReachThenZero) {
  World world;
  EXPECT_EQ(world.cast({0, 0}, 0.0, 10.0), 0.0);
  ASSERT_TRUE(world.add({{5, -1}, {5, 1}}));
  EXPECT_EQ(world.cast({0, 0}, 0.0, 4.99), 0.0) << "beyond the range";
  EXPECT_EQ(world.cast({0, 0}, kPi, 10.0), 0.0) << "behind";
  EXPECT_EQ(world.cast({0, 0}, 0.3, 10.0), 0.0) << "beside";
  EXPECT_EQ(world.cast({5, -3}, kPi / 2, 10.0), 0.0) << "along its own line";
}

TEST(World, ClearanceIsTheDistanceToTheNearestPointOfAWall) {
  World world;
  EXPECT_EQ(world.clearance({0, 0}), std::numeric_limits<double>::infinity());
  ASSERT_TRUE(world.add({{0, 0}, {4, 0}}));
  EXPECT_DOUBLE_EQ(world.clearance({2, 1.5}), 1.5);
  EXPECT_DOUBLE_EQ(world.clearance({7, 4}), 5.0);
  EXPECT_DOUBLE_EQ(world.clearance({-3, -4}), 5.0);
  ASSERT_TRUE(world.add({{1, 1}, {1, 1}}));
  EXPECT_DOUBLE_EQ(world.clearance({1, 3}), 2.0) << "a wall without length is a point";
}

TEST(World, GivenAFullWorldThenNothingIsAdded) {
  World world;
  for (std::size_t i = 0; i < World::kCapacity - 3; ++i) {
    ASSERT_TRUE(world.add({{0, 0}, {1, static_cast<double>(i)}}));
  }
  EXPECT_FALSE(world.add_box({0, 0}, {1, 1}));
  EXPECT_EQ(world.walls().size(), World::kCapacity - 3);
  for (int i = 0; i < 3; ++i) { EXPECT_TRUE(world.add({{0, 0}, {1, 1}})); }
  EXPECT_FALSE(world.add({{0, 0}, {1, 1}}));
}

}  // namespace
}  // namespace picolo::sim
