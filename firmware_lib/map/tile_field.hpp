// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Exact truncated distances of one tile to the nearest obstacle, by bits instead of cell by cell.
/// Private to the rolling map.
#pragma once

#include <cstdint>
#include <span>

namespace picolo::inline v0 {

struct TileRequest {
  const std::int8_t* occupancy;  ///< width * height, row-major
  std::uint8_t* field;           ///< the same cells
  int width;
  int height;
  int column;  ///< the tile's first cell
  int row;
  int radius;         ///< cells; obstacles further away do not matter
  int occupied_from;  ///< log-odds
  /// radius^2 + 1 bytes, by squared distance in cells; the last is that of everything beyond.
  std::span<const std::uint8_t> byte_of_square;
};

/// Writes the tile's bytes of the field. Cost: radius 6: at most 15 000 instructions.
void compute_tile_field(const TileRequest& request);

}  // namespace picolo::inline v0
