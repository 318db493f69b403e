// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/map_mosaic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace picolo {
namespace {

using host::MapCell;
using host::MapMosaic;
using host::OccupancyImage;

MapCell cell_at(const OccupancyImage& image, double x_m, double y_m) {
  const double column = std::floor((x_m - image.origin_x_m) / image.resolution_m);
  const double row = std::floor((y_m - image.origin_y_m) / image.resolution_m);
  if (column < 0.0 || row < 0.0 || column >= static_cast<double>(image.width) ||
      row >= static_cast<double>(image.height)) {
    return MapCell::unknown;
  }
  return image.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
}

/// One beam from the vehicle to a wall 2 m to its left.
void see_wall(RollingMapCore& map, const Pose2d& map_T_base) {
  map.begin_scan();
  const Pose2f at = to_window(map.window(), map_T_base);
  map.add_hit({at.x_m, at.y_m + 2.0F});
  map.add_ray({at.x_m, at.y_m}, {at.x_m, at.y_m + 2.0F}, 2);
}

TEST(MapMosaic, KeepsWhatTheWindowForgets) {
  const auto map = std::make_unique<RollingMap<128, 128>>(MapConfig{.cell_m = 0.1F});
  MapMosaic mosaic;
  map->core().reset(0.0, 0.0);
  for (int i = 0; i <= 120; ++i) {
    const Pose2d map_T_base{0.5 * i - 29.96, 0.04, 0.0};
    mosaic.watch(map->core(), map_T_base);
    map->core().follow(map_T_base.x_m, map_T_base.y_m);
    see_wall(map->core(), map_T_base);
  }
  mosaic.absorb(map->core());
  const OccupancyImage image = mosaic.image();
  EXPECT_GT(static_cast<double>(image.width) * image.resolution_m, 60.0) << "the window has 12.8 m";
  for (int i = 0; i <= 120; ++i) {
    EXPECT_EQ(cell_at(image, 0.5 * i - 29.96, 2.04), MapCell::occupied) << i;
    EXPECT_EQ(cell_at(image, 0.5 * i - 29.96, 0.54), MapCell::free) << i;
  }
  EXPECT_EQ(cell_at(image, 0.0, 3.0), MapCell::unknown);
}

TEST(MapMosaic, TheNewerViewOfACellCounts) {
  const auto map = std::make_unique<RollingMap<128, 128>>(MapConfig{.cell_m = 0.1F});
  MapMosaic mosaic;
  map->core().reset(0.0, 0.0);
  see_wall(map->core(), {0.04, 0.04, 0.0});
  mosaic.absorb(map->core());
  for (int i = 0; i < 20; ++i) {
    map->core().begin_scan();
    const Pose2f at = to_window(map->core().window(), Pose2d{0.04, 0.04, 0.0});
    map->core().add_ray({at.x_m, at.y_m}, {at.x_m, at.y_m + 4.0F}, 2);
  }
  mosaic.absorb(map->core());
  EXPECT_EQ(cell_at(mosaic.image(), 0.04, 2.04), MapCell::free);
}

TEST(MapMosaic, NothingSeenIsAnEmptyImage) {
  EXPECT_TRUE(MapMosaic{}.image().cells.empty());
}

}  // namespace
}  // namespace picolo
