// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/rolling_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr int kSize = 64;
using Map = RollingMap<kSize, kSize>;

std::int8_t log_odds(const RollingMapCore& map, int column, int row) {
  return map.occupancy()[static_cast<std::size_t>(row * kSize + column)];
}

Point2f centre_of(int column, int row) {
  return {(static_cast<float>(column) + 0.5F) * 0.05F, (static_cast<float>(row) + 0.5F) * 0.05F};
}

TEST(RollingMap, ACellChangesOnceAScanAndHitsComeFirst) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  core.begin_scan();
  core.add_hit(centre_of(30, 10));
  core.add_hit(centre_of(30, 10));
  core.add_ray(centre_of(10, 10), centre_of(50, 10), 0);  // passes through the hit cell
  core.add_ray(centre_of(10, 10), centre_of(50, 10), 0);
  EXPECT_EQ(log_odds(core, 30, 10), 40);
  EXPECT_EQ(log_odds(core, 20, 10), -10);
  core.begin_scan();
  core.add_ray(centre_of(10, 10), centre_of(50, 10), 0);
  EXPECT_EQ(log_odds(core, 30, 10), 30);
  EXPECT_EQ(log_odds(core, 20, 10), -20);
}

TEST(RollingMap, LogOddsSaturate) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  for (int i = 0; i < 20; ++i) {
    core.begin_scan();
    core.add_hit(centre_of(30, 10));
    core.add_ray(centre_of(5, 5), centre_of(5, 20), 0);
  }
  EXPECT_EQ(log_odds(core, 30, 10), 100);
  EXPECT_EQ(log_odds(core, 5, 10), -60);
}

TEST(RollingMap, RaysStopShortOfTheirEnd) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  core.begin_scan();
  core.add_ray(centre_of(10, 20), centre_of(40, 20), 2);
  EXPECT_EQ(log_odds(core, 10, 20), -10);
  EXPECT_EQ(log_odds(core, 37, 20), -10);
  EXPECT_EQ(log_odds(core, 38, 20), 0);
  EXPECT_EQ(log_odds(core, 40, 20), 0);
}

TEST(RollingMap, RaysFollowTheLineInEveryOctant) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  for (int k = 0; k < 64; ++k) {
    const double bearing = 2.0 * 3.14159265 * k / 64.0;
    const int to_column = 32 + static_cast<int>(std::lround(25 * std::cos(bearing)));
    const int to_row = 32 + static_cast<int>(std::lround(25 * std::sin(bearing)));
    core.reset(0.5 * kSize * 0.05, 0.5 * kSize * 0.05);
    core.begin_scan();
    core.add_ray(centre_of(32, 32), centre_of(to_column, to_row), 0);
    int cleared = 0;
    for (int row = 0; row < kSize; ++row) {
      for (int column = 0; column < kSize; ++column) {
        if (log_odds(core, column, row) == 0) { continue; }
        ++cleared;
        const double length = std::hypot(to_column - 32, to_row - 32);
        const double off =
            std::abs((to_column - 32) * (row - 32) - (to_row - 32) * (column - 32)) / length;
        EXPECT_LE(off, 0.5 * std::sqrt(2.0) + 1e-9);
      }
    }
    EXPECT_EQ(cleared, std::max(std::abs(to_column - 32), std::abs(to_row - 32)));
  }
}

TEST(RollingMap, WhatLiesOutsideHasNoEffect) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  core.begin_scan();
  core.add_hit({-1.0F, 1.0F});
  core.add_hit({1.0F, 1e30F});
  core.add_hit({std::nanf(""), 1.0F});
  core.add_ray({-1.0F, -1.0F}, {2.0F, 2.0F}, 0);
  for (const std::int8_t cell : core.occupancy()) { ASSERT_EQ(cell, 0); }
  core.add_ray(centre_of(32, 32), {1e6F, 1.6F}, 0);  // leaves the window, ends there
  EXPECT_EQ(log_odds(core, 63, 32), -10);
}

TEST(RollingMap, FollowingKeepsWhatStaysInTheMapFrame) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  core.reset(0.0, 0.0);
  const Pose2d wall{0.62, -0.31, 0.0};
  core.begin_scan();
  const Pose2f before = to_window(core.window(), wall);
  core.add_hit({before.x_m, before.y_m});
  const float value = sample_field(core.field(), before.x_m, before.y_m).value;
  EXPECT_GT(value, 0.9F);

  EXPECT_FALSE(core.follow(0.3, 0.1)) << "near the centre nothing moves";
  const GridWindow unmoved = core.window();
  EXPECT_TRUE(core.follow(1.0, -1.0));
  EXPECT_EQ((core.window().origin_x_cells - unmoved.origin_x_cells) % kTileCells, 0);
  EXPECT_GT(core.window().origin_x_cells, unmoved.origin_x_cells);
  EXPECT_LT(core.window().origin_y_cells, unmoved.origin_y_cells);
  const Pose2f after = to_window(core.window(), wall);
  EXPECT_NEAR(sample_field(core.field(), after.x_m, after.y_m).value, value, 1e-4F);
  EXPECT_EQ(sample_field(core.field(), after.x_m + 0.8F, after.y_m).value, 0.0F);

  EXPECT_TRUE(core.follow(100.0, 100.0));
  for (const std::int8_t cell : core.occupancy()) {
    ASSERT_EQ(cell, 0) << "a far jump forgets everything";
  }
  EXPECT_EQ(core.field().cells[0], 255);
}

TEST(RollingMap, StaleTilesMoveWithTheWindow) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  core.reset(0.0, 0.0);
  for (int scan = 0; scan < 6; ++scan) {
    core.begin_scan();
    if (scan == 0) { core.add_hit(centre_of(32, 32)); }
    if (scan > 0) { core.add_ray(centre_of(20, 32), centre_of(45, 32), 0); }
  }
  ASSERT_GT(core.stale_tiles(), 0);
  ASSERT_TRUE(core.follow(1.0, 0.0));
  while (core.stale_tiles() > 0) { ASSERT_GT(core.repair(1), 0); }
  for (int i = 0; i < kSize * kSize; ++i) { ASSERT_EQ(core.field().cells[i], 255); }
}

TEST(RollingMap, ResetForgets) {
  auto map = std::make_unique<Map>();
  map->core().begin_scan();
  map->core().add_hit(centre_of(3, 3));
  map->core().reset(10.0, -20.0);
  for (const std::int8_t cell : map->core().occupancy()) { ASSERT_EQ(cell, 0); }
  const Pose2f centre = to_window(map->core().window(), {10.0, -20.0, 0.0});
  EXPECT_NEAR(centre.x_m, 0.5 * kSize * 0.05, 0.05);
  EXPECT_NEAR(centre.y_m, 0.5 * kSize * 0.05, 0.05);
}

TEST(MapConfig, RefusesWhatCannotWork) {
  EXPECT_TRUE(MapConfig{}.valid());
  EXPECT_FALSE((MapConfig{.cell_m = 0.0F}).valid());
  EXPECT_FALSE((MapConfig{.field_radius_cells = kMaxFieldRadius + 1}).valid());
  EXPECT_FALSE((MapConfig{.miss = 5}).valid());
  EXPECT_FALSE((MapConfig{.high = 10}).valid());
}

TEST(GridWindow, ThereAndBack) {
  const GridWindow window{64, 64, 0.05F, -1234, 5678};
  const Pose2d pose{-60.1, 285.3, 2.0};
  const Pose2d back = to_map(window, to_window(window, pose));
  EXPECT_NEAR(back.x_m, pose.x_m, 1e-6);
  EXPECT_NEAR(back.y_m, pose.y_m, 1e-6);
}

/// Bresenham's line as the textbook has it.
std::vector<std::pair<int, int>> textbook_line(int x, int y, int to_x, int to_y, int stop) {
  const int dx = std::abs(to_x - x);
  const int dy = std::abs(to_y - y);
  int error = dx - dy;
  std::vector<std::pair<int, int>> cells;
  for (int i = 0; i < std::max(dx, dy) - stop; ++i) {
    cells.emplace_back(x, y);
    const int twice = 2 * error;
    if (twice > -dy) {
      error -= dy;
      x += to_x > x ? 1 : -1;
    }
    if (twice < dx) {
      error += dx;
      y += to_y > y ? 1 : -1;
    }
  }
  return cells;
}

TEST(RollingMap, RaysClearTheCellsOfTheTextbookLineInsideAndAcrossTheEdge) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  Random random{5};
  const auto below = [&random](int limit) {
    return static_cast<int>(random.next_u32() % 1000) % limit;
  };
  for (int k = 0; k < 3000; ++k) {
    core.place(0, 0);
    const bool leaves = k % 4 == 0;
    const int x = below(kSize);
    const int y = below(kSize);
    const int to_x = leaves ? below(3 * kSize) - kSize : below(kSize);
    const int to_y = leaves ? below(3 * kSize) - kSize : below(kSize);
    core.begin_scan();
    core.add_ray(centre_of(x, y), centre_of(to_x, to_y), k % 3);
    std::vector<std::int8_t> expected(kSize * kSize);
    for (const auto& [column, row] : textbook_line(x, y, to_x, to_y, k % 3)) {
      if (column < 0 || row < 0 || column >= kSize || row >= kSize) { break; }
      expected[static_cast<std::size_t>(row * kSize + column)] = -10;
    }
    ASSERT_TRUE(std::ranges::equal(core.occupancy(), expected))
        << x << " " << y << " to " << to_x << " " << to_y;
  }
}

}  // namespace
}  // namespace picolo
