// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The bilinear field: value, gradient against differences, borders. The distance field: exact
// against brute force, whatever was added and cleared before.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/map/rolling_map.hpp"

namespace picolo {
namespace {

constexpr int kSize = 96;
using Map = RollingMap<kSize, kSize>;

std::unique_ptr<Map> empty_map(MapConfig config = {}) {
  auto map = std::make_unique<Map>(config);
  map->core().reset(0.5 * kSize * 0.05,
                    0.5 * kSize * 0.05);  // window coordinates = map coordinates
  return map;
}

Point2f centre_of(int column, int row) {
  return {(static_cast<float>(column) + 0.5F) * 0.05F, (static_cast<float>(row) + 0.5F) * 0.05F};
}

std::uint8_t brute_force_byte(const RollingMapCore& map, int column, int row) {
  const int radius = map.config().field_radius_cells;
  int best = radius * radius;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      if (map.occupancy()[static_cast<std::size_t>(y * kSize + x)] < map.config().occupied_from) {
        continue;
      }
      best = std::min(best, (x - column) * (x - column) + (y - row) * (y - row));
    }
  }
  return static_cast<std::uint8_t>(std::lround(255.0 * std::sqrt(best) / radius));
}

void expect_exact_field(const RollingMapCore& map) {
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      ASSERT_EQ(map.field().cells[row * kSize + column], brute_force_byte(map, column, row))
          << "column " << column << " row " << row;
    }
  }
}

class DistanceFieldRadius : public ::testing::TestWithParam<int> {};

TEST_P(DistanceFieldRadius, EqualsBruteForceAfterRandomHitsAndClears) {
  auto map = empty_map({.field_radius_cells = GetParam()});
  Random random{static_cast<std::uint64_t>(GetParam())};
  for (int scan = 0; scan < 30; ++scan) {
    map->core().begin_scan();
    for (int i = 0; i < 6; ++i) {
      const auto column = static_cast<int>(random.below(kSize));
      const auto row = static_cast<int>(random.below(kSize));
      map->core().add_hit(centre_of(column, row));
    }
    for (int i = 0; i < 12; ++i) {
      const auto column = static_cast<int>(random.below(kSize));
      const auto row = static_cast<int>(random.below(kSize));
      map->core().add_ray(centre_of(48, 48), centre_of(column, row), 0);
    }
    while (map->core().stale_tiles() > 0) { ASSERT_GT(map->core().repair(3), 0); }
    if (scan % 10 == 9) { expect_exact_field(map->core()); }
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, DistanceFieldRadius, ::testing::Values(2, 6, 10));

TEST(DistanceField, RepairIsNeededAndSufficientAfterAnObstacleLeaves) {
  auto map = empty_map();
  map->core().begin_scan();
  map->core().add_hit(centre_of(40, 40));
  for (int i = 0; i < 6; ++i) {
    map->core().begin_scan();
    map->core().add_ray(centre_of(30, 40), centre_of(60, 40), 0);
  }
  ASSERT_LT(map->core().occupancy()[40 * kSize + 40], map->core().config().occupied_from);
  EXPECT_EQ(map->core().field().cells[40 * kSize + 40], 0)
      << "the field may lag, that is what stale tiles say";
  EXPECT_GT(map->core().stale_tiles(), 0);
  while (map->core().stale_tiles() > 0) { map->core().repair(1); }
  expect_exact_field(map->core());
  EXPECT_EQ(map->core().repair(10), 0);
}

TEST(BilinearField, IsOneOnAnObstacleAndZeroBeyondItsReach) {
  auto map = empty_map();
  map->core().begin_scan();
  map->core().add_hit(centre_of(40, 40));
  const DistanceFieldView field = map->core().field();
  EXPECT_FLOAT_EQ(field.reach_m, 0.5F);
  const Point2f obstacle = centre_of(40, 40);
  EXPECT_NEAR(sample_field(field, obstacle.x_m, obstacle.y_m).value, 1.0F, 1e-5F);
  EXPECT_NEAR(sample_field(field, obstacle.x_m + 0.25F, obstacle.y_m).value, 0.5F, 5e-3F);
  EXPECT_NEAR(sample_field(field, obstacle.x_m + 0.6F, obstacle.y_m).value, 0.0F, 1e-5F);
}

TEST(BilinearField, GradientIsTheDerivativeOfTheSameForm) {
  auto map = empty_map();
  Random random{5};
  map->core().begin_scan();
  for (int i = 0; i < 40; ++i) {
    const auto column = static_cast<int>(random.below(kSize));
    const auto row = static_cast<int>(random.below(kSize));
    map->core().add_hit(centre_of(column, row));
  }
  const DistanceFieldView field = map->core().field();
  int checked = 0;
  for (int i = 0; i < 5000; ++i) {
    // The centre of a random cell of the interpolation, so that the difference quotient does not
    // straddle two forms.
    const float x_m = (static_cast<float>(1 + random.below(kSize - 3)) + 0.5F + 0.2F +
                       0.6F * random.uniform_f32()) *
                      0.05F;
    const float y_m = (static_cast<float>(1 + random.below(kSize - 3)) + 0.5F + 0.2F +
                       0.6F * random.uniform_f32()) *
                      0.05F;
    const FieldSample at = sample_field(field, x_m, y_m);
    constexpr float kStep = 0.004F;
    const float dx = (sample_field(field, x_m + kStep, y_m).value -
                      sample_field(field, x_m - kStep, y_m).value) /
                     (2 * kStep);
    const float dy = (sample_field(field, x_m, y_m + kStep).value -
                      sample_field(field, x_m, y_m - kStep).value) /
                     (2 * kStep);
    ASSERT_NEAR(at.slope_x_per_m, dx, 2e-3F);
    ASSERT_NEAR(at.slope_y_per_m, dy, 2e-3F);
    checked += at.slope_x_per_m != 0.0F ? 1 : 0;
  }
  EXPECT_GT(checked, 1000);
}

TEST(BilinearField, WeightsAreNotBlendedTheWrongWayRound) {
  // Four different corner values: M = 0.1, 0.4, 0.9, 0.6 at (x0,y0), (x1,y0), (x1,y1), (x0,y1); a
  // quarter up, a tenth along.
  const std::uint8_t cells[] = {static_cast<std::uint8_t>(230), 153, 102,
                                26};  // distances 0.9, 0.6 / 0.4, 0.1 of 255
  const DistanceFieldView field{cells, 2, 2, 1.0F, 1.0F};
  const FieldSample at = sample_field(field, 0.5F + 0.1F, 0.5F + 0.25F);
  const double m1 = 1.0 - 230 / 255.0;
  const double m2 = 1.0 - 153 / 255.0;
  const double m3 = 1.0 - 26 / 255.0;
  const double m4 = 1.0 - 102 / 255.0;
  EXPECT_NEAR(at.value, 0.25 * (0.1 * m3 + 0.9 * m4) + 0.75 * (0.1 * m2 + 0.9 * m1), 1e-6);
  EXPECT_NEAR(at.slope_x_per_m, 0.25 * (m3 - m4) + 0.75 * (m2 - m1), 1e-6);
  EXPECT_NEAR(at.slope_y_per_m, 0.1 * (m3 - m2) + 0.9 * (m4 - m1), 1e-6);
}

TEST(BilinearField, OutsideAndNonsenseAreOutside) {
  auto map = empty_map();
  const DistanceFieldView field = map->core().field();
  const float nan = std::nanf("");
  for (const Point2f p : {Point2f{-0.1F, 1.0F}, Point2f{1.0F, 4.79F}, Point2f{1e9F, 1.0F},
                          Point2f{nan, 1.0F}, Point2f{1.0F, nan}, Point2f{0.02F, 1.0F}}) {
    const FieldSample at = sample_field(field, p.x_m, p.y_m);
    EXPECT_EQ(at.inside, 0.0F);
    EXPECT_EQ(at.value, 0.0F);
    EXPECT_EQ(at.slope_x_per_m, 0.0F);
  }
}

}  // namespace
}  // namespace picolo
