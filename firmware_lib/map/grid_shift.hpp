// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Moving the content of a grid by whole cells. Private to the map.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace picolo::inline v0 {

/// new(column, row) = old(column + dx, row + dy), `unknown` where that is outside. Cost: O(width *
/// height).
template <typename Cell>
void shift_grid(std::span<Cell> cells, int width, int height, int dx, int dy, Cell unknown) {
  const auto line = [&](int row) {
    return cells.subspan(static_cast<std::size_t>(row) * static_cast<std::size_t>(width),
                         static_cast<std::size_t>(width));
  };
  const bool upwards =
      dy >= 0;  // copy in the direction that does not overwrite what is still needed
  for (int i = 0; i < height; ++i) {
    const int row = upwards ? i : height - 1 - i;
    const int from = row + dy;
    const auto to_line = line(row);
    if (from < 0 || from >= height || dx >= width || dx <= -width) {
      std::fill(to_line.begin(), to_line.end(), unknown);
      continue;
    }
    const auto from_line = line(from);
    if (dx >= 0) {
      std::copy(from_line.begin() + dx, from_line.end(), to_line.begin());
      std::fill(to_line.end() - dx, to_line.end(), unknown);
    } else {
      std::copy_backward(from_line.begin(), from_line.end() + dx, to_line.end());
      std::fill(to_line.begin(), to_line.begin() - dx, unknown);
    }
  }
}

}  // namespace picolo::inline v0
