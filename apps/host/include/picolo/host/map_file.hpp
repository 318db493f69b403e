// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A map as ROS's map_server reads it: a grey PGM picture and a YAML file beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace picolo::host {

enum class MapCell : std::uint8_t { unknown, free, occupied };

/// Row-major from the corner of lowest x and y: cell (column, row) covers
/// [origin + column * resolution, origin + (column + 1) * resolution) in x, likewise in y.
struct OccupancyImage {
  std::size_t width = 0;
  std::size_t height = 0;
  double resolution_m = 0.05;
  double origin_x_m = 0.0;
  double origin_y_m = 0.0;
  std::vector<MapCell> cells;

  [[nodiscard]] MapCell at(std::size_t column, std::size_t row) const {
    return cells[row * width + column];
  }
};

/// The smallest part that holds every known cell, plus `margin` cells of unknown around it.
/// A map without a known cell stays as it is.
[[nodiscard]] OccupancyImage crop(const OccupancyImage& map, std::size_t margin);

/// Writes STEM.pgm (occupied 0, free 254, unknown 205; top row first) and STEM.yaml (trinary,
/// negate 0, thresholds 0.65 and 0.196). Throws UserError (usage, device).
void write_map(const std::filesystem::path& folder, const std::string& stem,
               const OccupancyImage& map);

/// The map a YAML file of ROS's map_server describes, by its rules: modes trinary, scale and raw,
/// negate, thresholds; what is neither occupied nor free is unknown. The image is a PGM (P2 or P5),
/// its path relative to the YAML file. Throws UserError (input) with file and line; a turned origin
/// is refused.
[[nodiscard]] OccupancyImage read_map(const std::filesystem::path& yaml);

}  // namespace picolo::host
