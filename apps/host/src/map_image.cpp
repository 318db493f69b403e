// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/map_image.hpp"

namespace picolo::host {

MapCell cell_of(std::int8_t log_odds, const MapConfig& config) {
  if (log_odds >= config.occupied_from) { return MapCell::occupied; }
  return log_odds < 0 ? MapCell::free : MapCell::unknown;
}

OccupancyImage image_of(const RollingMapCore& map) {
  const GridWindow& window = map.window();
  const auto cell_m = static_cast<double>(window.cell_m);
  OccupancyImage image;
  image.width = static_cast<std::size_t>(window.width);
  image.height = static_cast<std::size_t>(window.height);
  image.resolution_m = cell_m;
  image.origin_x_m = cell_m * window.origin_x_cells;
  image.origin_y_m = cell_m * window.origin_y_cells;
  image.cells.reserve(map.occupancy().size());
  for (const std::int8_t odds : map.occupancy()) {
    image.cells.push_back(cell_of(odds, map.config()));
  }
  return image;
}

}  // namespace picolo::host
