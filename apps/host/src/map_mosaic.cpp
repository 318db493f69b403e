// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/map_mosaic.hpp"

#include <algorithm>
#include <cmath>

#include "picolo/host/map_image.hpp"

namespace picolo::host {
namespace {

constexpr std::size_t kMargin = 10;  // cells around the drawing

std::int32_t floor_div(std::int32_t value, std::int32_t divisor) {
  return value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor);
}

}  // namespace

void MapMosaic::watch(const RollingMapCore& map, const Pose2d& map_T_base) {
  const GridWindow& window = map.window();
  const auto cell_m = static_cast<double>(window.cell_m);
  const double width_m = window.width * cell_m;
  const double height_m = window.height * cell_m;
  const double off_x_m =
      std::abs(map_T_base.x_m - window.origin_x_cells * cell_m - 0.5 * width_m) / width_m;
  const double off_y_m =
      std::abs(map_T_base.y_m - window.origin_y_cells * cell_m - 0.5 * height_m) / height_m;
  // the window moves at a quarter of its size; one step of a vehicle is less than a sixth of it
  constexpr double kNear = 1.0 / 4.0 - 1.0 / 6.0;
  const double moved_m =
      std::hypot(map_T_base.x_m - absorbed_at_.x_m, map_T_base.y_m - absorbed_at_.y_m);
  if (std::max(off_x_m, off_y_m) < kNear || (absorbed_ && moved_m < 0.02 * width_m)) { return; }
  absorb(map);
  absorbed_at_ = map_T_base;
}

void MapMosaic::absorb(const RollingMapCore& map) {
  const GridWindow& window = map.window();
  cell_m_ = static_cast<double>(window.cell_m);
  absorbed_ = true;
  const auto occupancy = map.occupancy();
  for (int row = 0; row < window.height; ++row) {
    const std::int32_t y = window.origin_y_cells + row;
    const std::int32_t tile_y = floor_div(y, kTile);
    Tile* tile = nullptr;
    std::int32_t tile_x = 0;
    for (int column = 0; column < window.width; ++column) {
      const std::int8_t value = occupancy[static_cast<std::size_t>(row * window.width + column)];
      if (value == 0) { continue; }
      const std::int32_t x = window.origin_x_cells + column;
      if (tile == nullptr || tile_x != floor_div(x, kTile)) {
        tile_x = floor_div(x, kTile);
        tile = &tiles_[{tile_x, tile_y}];
      }
      (*tile)[static_cast<std::size_t>((y - tile_y * kTile) * kTile + x - tile_x * kTile)] =
          cell_of(value, map.config());
    }
  }
}

OccupancyImage MapMosaic::image() const {
  OccupancyImage whole;
  whole.resolution_m = cell_m_;
  if (tiles_.empty()) { return whole; }
  auto [left, low] = tiles_.begin()->first;
  auto [right, high] = tiles_.begin()->first;
  for (const auto& [place, tile] : tiles_) {
    left = std::min(left, place.first);
    right = std::max(right, place.first);
    low = std::min(low, place.second);
    high = std::max(high, place.second);
  }
  whole.width = static_cast<std::size_t>(right - left + 1) * kTile;
  whole.height = static_cast<std::size_t>(high - low + 1) * kTile;
  whole.origin_x_m = left * kTile * cell_m_;
  whole.origin_y_m = low * kTile * cell_m_;
  whole.cells.assign(whole.width * whole.height, MapCell::unknown);
  for (const auto& [place, tile] : tiles_) {
    const auto column = static_cast<std::size_t>(place.first - left) * kTile;
    const auto row = static_cast<std::size_t>(place.second - low) * kTile;
    for (std::size_t k = 0; k < kTile; ++k) {
      std::copy_n(
          tile.begin() + static_cast<std::ptrdiff_t>(k * kTile), kTile,
          whole.cells.begin() + static_cast<std::ptrdiff_t>((row + k) * whole.width + column));
    }
  }
  return crop(whole, kMargin);
}

}  // namespace picolo::host
