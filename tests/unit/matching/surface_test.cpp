// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

struct Directions {
  std::vector<std::int8_t> x;
  std::vector<std::int8_t> y;
  [[nodiscard]] bool known(std::size_t k) const { return x[k] != 0 || y[k] != 0; }
};

struct Points {
  std::vector<float> x_m;
  std::vector<float> y_m;
  void add(double x, double y) {
    x_m.push_back(static_cast<float>(x));
    y_m.push_back(static_cast<float>(y));
  }
  [[nodiscard]] Directions directions(const SurfaceConfig& config = {}) const {
    Directions result{std::vector<std::int8_t>(x_m.size(), 9),
                      std::vector<std::int8_t>(x_m.size(), 9)};
    surface_directions({x_m, y_m}, config, result.x, result.y);
    return result;
  }
};

TEST(Surface, FollowsAWallHoweverDenseItsPoints) {
  for (const double spacing_m : {0.01, 0.05, 0.2, 1.5}) {
    Points points;
    for (int k = 0; k < 40; ++k) {
      points.add(2.0 + spacing_m * k * std::cos(0.7), 1.0 + spacing_m * k * std::sin(0.7));
    }
    const Directions along = points.directions();
    for (std::size_t k = 1; k + 1 < 40; ++k) {
      EXPECT_NEAR(along.x[k], 127.0 * std::cos(0.7), 0.6) << spacing_m << " m, point " << k;
      EXPECT_NEAR(along.y[k], 127.0 * std::sin(0.7), 0.6);
    }
    EXPECT_EQ(along.known(0), spacing_m >= 0.6) << "a dense wall ends here, a sparse one anywhere";
    EXPECT_EQ(along.known(39), spacing_m >= 0.6);
  }
}

TEST(Surface, HoldsWithRangeNoiseOfACentimetre) {
  Random random{3};
  Points points;
  for (int k = 0; k < 400; ++k) { points.add(0.02 * k, 1.0 + 0.01 * random.gaussian()); }
  const Directions along = points.directions();
  int known = 0;
  double squares = 0.0;
  for (std::size_t k = 0; k < 400; ++k) {
    if (!along.known(k)) { continue; }
    ++known;
    squares += std::pow(along.y[k] / 127.0, 2);
  }
  EXPECT_GT(known, 360);
  EXPECT_LT(std::sqrt(squares / known), 0.06)
      << "rad: what the limit of the condition reckons with";
}

TEST(Surface, IsUnknownAtCornersEdgesAndSingleThings) {
  Points points;
  for (int k = 0; k < 20; ++k) { points.add(0.1 * k, 0.0); }        // a wall, ...
  for (int k = 1; k < 20; ++k) { points.add(1.9, 0.1 * k); }        // ... its corner at 19, ...
  for (int k = 0; k < 20; ++k) { points.add(5.0 - 0.1 * k, 4.0); }  // ... far behind its edge at 38
  const Directions along = points.directions();
  EXPECT_FALSE(along.known(19));
  EXPECT_FALSE(along.known(38));
  EXPECT_FALSE(along.known(39));
  EXPECT_TRUE(along.known(10));
  EXPECT_TRUE(along.known(30));
  EXPECT_TRUE(along.known(50));

  Points scattered;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 3}, {4, 1}, {2, 2}, {5, 5}}) {
    scattered.add(x, y);
  }
  for (std::size_t k = 0; k < 5; ++k) { EXPECT_FALSE(scattered.directions().known(k)); }
}

TEST(Surface, APoleBetweenSparseHitsHasNone) {
  Points points;
  for (int k = 0; k < 6; ++k) { points.add(0.8 * k, 3.0); }
  points.add(4.4, 1.0);
  for (int k = 6; k < 12; ++k) { points.add(0.8 * k, 3.0); }
  const Directions along = points.directions();
  for (std::size_t k = 0; k < 13; ++k) { EXPECT_EQ(along.known(k), k != 6) << k; }
}

TEST(Surface, OfFewPointsOrSmallStorageIsNoTrouble) {
  Points points;
  EXPECT_TRUE(points.directions().x.empty());
  points.add(1.0, 1.0);
  EXPECT_FALSE(points.directions().known(0));
  points.add(1.0, 1.0);  // equal points
  points.add(1.0, 1.0);
  for (std::size_t k = 0; k < 3; ++k) { EXPECT_FALSE(points.directions().known(k)); }
}

}  // namespace
}  // namespace picolo
