// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Moving the content of a grid by whole cells. Private to the map.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace picolo::inline v0 {

/// Like std::copy, or `downwards` like std::copy_backward. Bytes go in blocks: the byte loops of
/// small C libraries take three times as long.
template <typename Cell>
void move_cells(const Cell* from, Cell* to, std::size_t count, bool downwards) {
  if constexpr (sizeof(Cell) == 1) {
    constexpr std::size_t kBlock = 16;
    const auto shift = static_cast<std::size_t>(downwards ? to - from : from - to);
    if (count % kBlock == 0 && shift % kBlock == 0) {
      for (std::size_t i = 0; i < count; i += kBlock) {
        const std::size_t at = downwards ? count - kBlock - i : i;
        std::array<std::uint32_t, kBlock / 4> block;
        std::memcpy(block.data(), from + at, kBlock);
        std::memcpy(to + at, block.data(), kBlock);
      }
      return;
    }
  }
  if (downwards) {
    std::copy_backward(from, from + count, to + count);
  } else {
    std::copy(from, from + count, to);
  }
}

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
    const auto right = static_cast<std::size_t>(std::max(dx, 0));
    const auto left = static_cast<std::size_t>(std::max(-dx, 0));
    if (dx >= 0) {
      move_cells(from_line.data() + dx, to_line.data(), to_line.size() - right, false);
      std::fill(to_line.end() - dx, to_line.end(), unknown);
    } else {
      move_cells(from_line.data(), to_line.data() - dx, to_line.size() - left, true);
      std::fill(to_line.begin(), to_line.begin() - dx, unknown);
    }
  }
}

}  // namespace picolo::inline v0
