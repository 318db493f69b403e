// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/ndt_map.hpp"

#include <algorithm>

#include "grid_shift.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr int kCellLimit = 1 << 20;

int cells_to_move(int cell_from_corner, int size) {
  const int from_centre = cell_from_corner - size / 2;
  return from_centre <= size / 4 && from_centre >= -size / 4 ? 0 : from_centre;
}

float half_if(int bit) {
  return bit != 0 ? 0.5F : 0.0F;
}

}  // namespace

NdtMapCore::NdtMapCore(const NdtMapConfig& config, int width, int height,
                       const std::array<std::span<NdtCell>, kNdtGrids>& grids)
    : config_(config), window_{width, height, config.cell_m, 0, 0}, grids_(grids) {
  reset(0.0, 0.0);
}

void NdtMapCore::reset(double centre_x_m, double centre_y_m) {
  const auto cell_m = static_cast<double>(config_.cell_m);
  window_.origin_x_cells =
      floor_to_i32(centre_x_m / cell_m, -kCellLimit, kCellLimit) - window_.width / 2;
  window_.origin_y_cells =
      floor_to_i32(centre_y_m / cell_m, -kCellLimit, kCellLimit) - window_.height / 2;
  for (const auto& grid : grids_) { std::fill(grid.begin(), grid.end(), NdtCell{}); }
}

bool NdtMapCore::follow(double x_m, double y_m) {
  const auto cell_m = static_cast<double>(config_.cell_m);
  const int dx = cells_to_move(
      floor_to_i32(x_m / cell_m, -kCellLimit, kCellLimit) - window_.origin_x_cells, window_.width);
  const int dy = cells_to_move(
      floor_to_i32(y_m / cell_m, -kCellLimit, kCellLimit) - window_.origin_y_cells, window_.height);
  if (dx == 0 && dy == 0) { return false; }
  for (const auto& grid : grids_) {
    shift_grid(grid, window_.width, window_.height, dx, dy, NdtCell{});
  }
  window_.origin_x_cells += dx;
  window_.origin_y_cells += dy;
  return true;
}

NdtView NdtMapCore::view() const {
  return {{grids_[0].data(), grids_[1].data(), grids_[2].data(), grids_[3].data()},
          window_.width,
          window_.height,
          config_.cell_m,
          1.0F / config_.cell_m};
}

void NdtMapCore::add(Point2f window_p) {
  const float cells_per_m = 1.0F / config_.cell_m;
  for (int g = 0; g < kNdtGrids; ++g) {
    const float u = window_p.x_m * cells_per_m + half_if(g & 1);
    const float v = window_p.y_m * cells_per_m + half_if(g >> 1);
    const int column = floor_to_i32(u, -1, window_.width);
    const int row = floor_to_i32(v, -1, window_.height);
    if (column < 0 || row < 0 || column >= window_.width || row >= window_.height) { continue; }
    NdtCell& cell = grids_[static_cast<std::size_t>(g)]
                          [static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.width) +
                           static_cast<std::size_t>(column)];
    add_to(cell, (u - static_cast<float>(column)) * config_.cell_m,
           (v - static_cast<float>(row)) * config_.cell_m);
  }
}

// Welford's update, then the inverse of the covariance with its eigenvalues held above a floor.
void NdtMapCore::add_to(NdtCell& cell, float x_m, float y_m) const {
  if (cell.count >= config_.max_points) {
    const float keep = static_cast<float>(config_.max_points - 1) / static_cast<float>(cell.count);
    cell.xx *= keep;
    cell.xy *= keep;
    cell.yy *= keep;
    cell.count = config_.max_points - 1;
  }
  ++cell.count;
  const auto n = static_cast<float>(cell.count);
  const float dx = x_m - cell.mean_x_m;
  const float dy = y_m - cell.mean_y_m;
  cell.mean_x_m += dx / n;
  cell.mean_y_m += dy / n;
  cell.xx += dx * (x_m - cell.mean_x_m);
  cell.xy += dx * (y_m - cell.mean_y_m);
  cell.yy += dy * (y_m - cell.mean_y_m);
  if (cell.count < config_.min_points) { return; }

  const float per_point = 1.0F / (n - 1.0F);
  const float xx = cell.xx * per_point;
  const float xy = cell.xy * per_point;
  const float yy = cell.yy * per_point;
  const float middle = 0.5F * (xx + yy);
  const float spread = hypotenuse(0.5F * (xx - yy), xy);
  const float floor = config_.min_sigma_m * config_.min_sigma_m;
  const float large = std::max(middle + spread, floor);
  const float small =
      std::max(middle - spread, std::max(floor, config_.min_eigenvalue_ratio * large));
  // With v the direction of the large eigenvalue, v v' = (C - (middle - spread) I) / (2 spread);
  // every matrix with these eigenvectors is p I - (p - q) v v', p across the wall, q along it.
  const float low = middle - spread;
  const float across = 1.0F / small;
  const float along = 1.0F / large;
  const float ratio = small / large;
  const float per_spread = spread > 0.0F ? 0.5F / spread : 0.0F;
  const float vv_xx = (xx - low) * per_spread;
  const float vv_xy = xy * per_spread;
  const float vv_yy = (yy - low) * per_spread;
  cell.inverse_xx = across - (across - along) * vv_xx;
  cell.inverse_xy = -(across - along) * vv_xy;
  cell.inverse_yy = across - (across - along) * vv_yy;
  const float worth = along * (ratio * ratio);
  cell.stiff_xx = across - (across - worth) * vv_xx;
  cell.stiff_xy = -(across - worth) * vv_xy;
  cell.stiff_yy = across - (across - worth) * vv_yy;
}

}  // namespace picolo::inline v0
