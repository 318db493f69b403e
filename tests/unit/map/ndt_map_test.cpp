// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Cells against the textbook mean and covariance, the guard against singular ones, the four
// overlapping grids and the window.

#include "picolo/map/ndt_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

using Map = NdtMap<32, 24>;

Point2f in_window(const Map& map, double x_m, double y_m) {
  const Pose2f pose = to_window(map.core().window(), {x_m, y_m, 0.0});
  return {pose.x_m, pose.y_m};
}

const NdtCell& cell_of(const Map& map, int grid, int column, int row) {
  const NdtView view = map.core().view();
  return view.grids[static_cast<std::size_t>(grid)][row * view.width + column];
}

TEST(NdtMap, GivenPointsOfOneCellThenMeanAndCovarianceAreThoseOfTheTextbook) {
  auto map = std::make_unique<Map>();
  Random random{4};
  std::vector<std::pair<double, double>> points;
  double mean_x = 0;
  double mean_y = 0;
  for (int i = 0; i < 200; ++i) {
    const double along = random.uniform(-0.2, 0.2);
    const double across = 0.05 * random.gaussian();
    points.emplace_back(0.25 + 0.6 * along - 0.3 * across, 0.25 + 0.5 * along + 0.4 * across);
    map->core().add(
        {static_cast<float>(points.back().first), static_cast<float>(points.back().second)});
    mean_x += points.back().first / 200;
    mean_y += points.back().second / 200;
  }
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x) / 199;
    xy += (x - mean_x) * (y - mean_y) / 199;
    yy += (y - mean_y) * (y - mean_y) / 199;
  }
  const NdtCell& cell = cell_of(*map, 0, 0, 0);
  ASSERT_EQ(cell.count, 200U);
  EXPECT_NEAR(cell.mean_x_m, mean_x, 1e-6);
  EXPECT_NEAR(cell.mean_y_m, mean_y, 1e-6);
  const double determinant = xx * yy - xy * xy;
  ASSERT_GT(0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy), 0.0)
      << "the points must span both directions";
  // No eigenvalue is under the floor of 3 cm here? The small one is: compare what the guard keeps.
  const auto a = static_cast<double>(cell.inverse_xx);
  const auto b = static_cast<double>(cell.inverse_xy);
  const auto c = static_cast<double>(cell.inverse_yy);
  const double small = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
  if (small > 0.0009) {
    EXPECT_NEAR(a, yy / determinant, 1e-3 * a);
    EXPECT_NEAR(b, -xy / determinant, 1e-3 * a);
    EXPECT_NEAR(c, xx / determinant, 1e-3 * c);
  } else {
    EXPECT_NEAR(0.5 * (a + c) + std::hypot(0.5 * (a - c), b), 1.0 / 0.0009, 1.0);
    EXPECT_NEAR(std::atan2(2 * b, a - c), std::atan2(-2 * xy, yy - xx), 1e-3)
        << "the guard must keep the directions";
  }
}

TEST(NdtMap, GivenARoundCloudThenTheInverseIsExact) {
  auto map = std::make_unique<Map>(NdtMapConfig{.min_sigma_m = 0.001F});
  // Four corners, twice: covariance is diagonal with 8 * d^2 / 7.
  for (int i = 0; i < 2; ++i) {
    for (const float sx : {-1.0F, 1.0F}) {
      for (const float sy : {-1.0F, 1.0F}) {
        map->core().add({0.25F + 0.1F * sx, 0.25F + 0.05F * sy});
      }
    }
  }
  const NdtCell& cell = cell_of(*map, 0, 0, 0);
  EXPECT_NEAR(cell.inverse_xx, 7.0F / 8.0F / 0.01F, 0.01F);
  EXPECT_NEAR(cell.inverse_yy, 7.0F / 8.0F / 0.0025F, 0.05F);
  EXPECT_NEAR(cell.inverse_xy, 0.0F, 1e-2F);
}

TEST(NdtMap, GivenAPerfectWallThenTheCellStaysInvertibleAndStiffAcrossIt) {
  auto map = std::make_unique<Map>();
  for (int i = 0; i < 40; ++i) { map->core().add({0.01F * static_cast<float>(i), 0.2F}); }
  const NdtCell& cell = cell_of(*map, 0, 0, 0);
  EXPECT_NEAR(cell.inverse_yy, 1.0F / (0.03F * 0.03F), 1.0F);
  EXPECT_LT(cell.inverse_xx, 100.0F);
  EXPECT_GT(cell.inverse_xx, 0.0F);
  EXPECT_NEAR(cell.stiff_yy, cell.inverse_yy, 1e-3F);
  EXPECT_LT(cell.stiff_xx, 0.02F * cell.inverse_xx) << "the cell's border is no landmark";
}

TEST(NdtMap, GivenIdenticalPointsThenTheFloorHoldsInEveryDirection) {
  auto map = std::make_unique<Map>();
  for (int i = 0; i < 10; ++i) { map->core().add({0.2F, 0.2F}); }
  const NdtCell& cell = cell_of(*map, 0, 0, 0);
  EXPECT_NEAR(cell.inverse_xx, 1.0F / 0.0009F, 1.0F);
  EXPECT_NEAR(cell.inverse_yy, 1.0F / 0.0009F, 1.0F);
  EXPECT_EQ(cell.inverse_xy, 0.0F);
}

TEST(NdtMap, GivenTooFewPointsThenACellSaysNothing) {
  auto map = std::make_unique<Map>(NdtMapConfig{.min_points = 5});
  for (int i = 0; i < 4; ++i) { map->core().add({0.1F * static_cast<float>(i), 0.2F}); }
  EXPECT_EQ(cell_of(*map, 0, 0, 0).count, 4U);
  EXPECT_EQ(cell_of(*map, 0, 0, 0).inverse_xx, 0.0F);
  map->core().add({0.3F, 0.25F});
  EXPECT_GT(cell_of(*map, 0, 0, 0).inverse_xx, 0.0F);
}

TEST(NdtMap, GivenOnePointThenEachOfTheFourGridsHoldsItInTheCellThatIsShiftedByAHalf) {
  auto map = std::make_unique<Map>();
  map->core().add({2.3F, 3.1F});  // cells of 0.5 m: 4.6, 6.2
  EXPECT_EQ(cell_of(*map, 0, 4, 6).count, 1U);
  EXPECT_EQ(cell_of(*map, 1, 5, 6).count, 1U);
  EXPECT_EQ(cell_of(*map, 2, 4, 6).count, 1U);
  EXPECT_EQ(cell_of(*map, 3, 5, 6).count, 1U);
  EXPECT_NEAR(cell_of(*map, 0, 4, 6).mean_x_m, 0.3F, 1e-5F);
  EXPECT_NEAR(cell_of(*map, 1, 5, 6).mean_x_m, 0.05F, 1e-5F);
  EXPECT_NEAR(cell_of(*map, 2, 4, 6).mean_y_m, 0.35F, 1e-5F);
}

TEST(NdtMap, GivenPointsOutsideOrNotANumberThenNothingChanges) {
  auto map = std::make_unique<Map>();
  for (const Point2f p : {Point2f{-0.3F, 1.0F}, Point2f{1.0F, -0.3F}, Point2f{16.5F, 1.0F},
                          Point2f{1.0F, 12.5F}, Point2f{std::nanf(""), 1.0F}}) {
    map->core().add(p);
  }
  for (int grid = 0; grid < kNdtGrids; ++grid) {
    for (int row = 0; row < 24; ++row) {
      for (int column = 0; column < 32; ++column) {
        ASSERT_EQ(cell_of(*map, grid, column, row).count, 0U)
            << grid << " " << column << "," << row;
      }
    }
  }
}

TEST(NdtMap, GivenManyPointsThenTheOldFadeAndTheCountStaysBounded) {
  auto map = std::make_unique<Map>(NdtMapConfig{.max_points = 50});
  for (int i = 0; i < 300; ++i) { map->core().add({0.1F, 0.1F}); }
  for (int i = 0; i < 500; ++i) { map->core().add({0.4F, 0.4F}); }
  const NdtCell& cell = cell_of(*map, 0, 0, 0);
  EXPECT_EQ(cell.count, 50U);
  EXPECT_NEAR(cell.mean_x_m, 0.4F, 1e-3F);
  EXPECT_GE(cell.xx, 0.0F);
}

TEST(NdtMap, GivenAVehicleThatDrivesAwayThenTheWindowFollowsAndKeepsWhatItCovers) {
  auto map = std::make_unique<Map>();
  for (int i = 0; i < 10; ++i) { map->core().add(in_window(*map, 3.2 + 0.01 * i, 1.1)); }
  EXPECT_FALSE(map->core().follow(1.0, 1.0));
  const std::int32_t before = map->core().window().origin_x_cells;
  EXPECT_TRUE(map->core().follow(6.0, 1.0));
  EXPECT_EQ(map->core().window().origin_x_cells, before + 12);
  const Point2f p = in_window(*map, 3.2, 1.1);
  const NdtCell& cell =
      cell_of(*map, 0, static_cast<int>(p.x_m * 2.0F), static_cast<int>(p.y_m * 2.0F));
  EXPECT_EQ(cell.count, 10U);
  EXPECT_TRUE(map->core().follow(500.0, -300.0));
  for (int i = 0; i < 32 * 24; ++i) { ASSERT_EQ(map->core().view().grids[0][i].count, 0U); }
  map->core().add(in_window(*map, 500.0, -300.0));
  map->core().reset(0.0, 0.0);
  for (int i = 0; i < 32 * 24; ++i) { ASSERT_EQ(map->core().view().grids[0][i].count, 0U); }
}

}  // namespace
}  // namespace picolo
