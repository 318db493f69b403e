// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"

namespace picolo::host {
namespace {

/// To the micrometre: 0.05, not 0.05000000074505806 as a float has it.
std::string metres(double value) {
  return plain_decimal(std::round(value * 1e6) / 1e6);
}

char grey(MapCell cell) {
  switch (cell) {
    case MapCell::occupied: return '\0';
    case MapCell::free: return static_cast<char>(254);
    case MapCell::unknown: break;
  }
  return static_cast<char>(205);
}

}  // namespace

OccupancyImage crop(const OccupancyImage& map, std::size_t margin) {
  std::size_t left = map.width;
  std::size_t right = 0;
  std::size_t low = map.height;
  std::size_t high = 0;
  for (std::size_t row = 0; row < map.height; ++row) {
    for (std::size_t column = 0; column < map.width; ++column) {
      if (map.at(column, row) != MapCell::unknown) {
        left = std::min(left, column);
        right = std::max(right, column);
        low = std::min(low, row);
        high = std::max(high, row);
      }
    }
  }
  if (left > right) { return map; }
  OccupancyImage part;
  part.resolution_m = map.resolution_m;
  part.width = right - left + 1 + 2 * margin;
  part.height = high - low + 1 + 2 * margin;
  const auto offset_m = [&map, margin](std::size_t cells) {
    return (static_cast<double>(cells) - static_cast<double>(margin)) * map.resolution_m;
  };
  part.origin_x_m = map.origin_x_m + offset_m(left);
  part.origin_y_m = map.origin_y_m + offset_m(low);
  part.cells.assign(part.width * part.height, MapCell::unknown);
  for (std::size_t row = low; row <= high; ++row) {
    for (std::size_t column = left; column <= right; ++column) {
      part.cells[(row - low + margin) * part.width + column - left + margin] = map.at(column, row);
    }
  }
  return part;
}

void write_map(const std::filesystem::path& folder, const std::string& stem,
               const OccupancyImage& map) {
  std::string pgm = fmt::format("P5\n{} {}\n255\n", map.width, map.height);
  pgm.reserve(pgm.size() + map.cells.size());
  for (std::size_t row = map.height; row-- > 0;) {
    for (std::size_t column = 0; column < map.width; ++column) {
      pgm.push_back(grey(map.at(column, row)));
    }
  }
  write_file(folder / (stem + ".pgm"), pgm);
  write_file(
      folder / (stem + ".yaml"),
      fmt::format("image: {}.pgm\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0.0]\n"
                  "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
                  stem, metres(map.resolution_m), metres(map.origin_x_m), metres(map.origin_y_m)));
}

}  // namespace picolo::host
