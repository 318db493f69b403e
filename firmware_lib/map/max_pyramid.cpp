// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/max_pyramid.hpp"

#include <algorithm>

namespace picolo::inline v0 {
namespace {

std::size_t index_of(int column, int row, int width) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(column);
}

}  // namespace

MaxPyramidCore::MaxPyramidCore(
    int width, int height, int levels,
    const std::array<std::span<std::uint8_t>, kMaxPyramidLevels>& storage)
    : storage_(storage) {
  view_.levels = levels;
  for (int level = 0; level < levels; ++level) {
    const auto l = static_cast<std::size_t>(level);
    view_.nearest[l] = storage_[l].data();
    view_.width[l] = width / MaxPyramidView::size_of(level);
    view_.height[l] = height / MaxPyramidView::size_of(level);
  }
}

void MaxPyramidCore::begin(const DistanceFieldView& field) {
  field_ = field;
  level_ = 0;
  row_ = 0;
  complete_ = false;
}

bool MaxPyramidCore::step(int max_rows) {
  for (int done = 0; done < max_rows && !complete_; ++done) {
    if (level_ == 0) {
      build_base_row(row_);
    } else {
      build_upper_row(level_, row_);
    }
    ++row_;
    if (row_ == view_.height[static_cast<std::size_t>(level_)]) {
      row_ = 0;
      ++level_;
      complete_ = level_ == view_.levels;
    }
  }
  return complete_;
}

void MaxPyramidCore::build_base_row(int row) {
  constexpr int kReach = 2 * kPyramidBaseCells;
  const int y0 = row * kPyramidBaseCells;
  const int y1 = std::min(y0 + kReach, field_.height);
  for (int column = 0; column < view_.width[0]; ++column) {
    const int x0 = column * kPyramidBaseCells;
    const int x1 = std::min(x0 + kReach, field_.width);
    std::uint8_t nearest = 255;
    for (int y = y0; y < y1; ++y) {
      const std::uint8_t* const line = field_.cells + index_of(0, y, field_.width);
      for (int x = x0; x < x1; ++x) { nearest = std::min(nearest, line[x]); }
    }
    storage_[0][index_of(column, row, view_.width[0])] = nearest;
  }
}

// A square of twice the side is covered by the four overlapping squares below it that begin at even
// corners and at the even corners after them.
void MaxPyramidCore::build_upper_row(int level, int row) {
  const auto upper = static_cast<std::size_t>(level);
  const std::size_t lower = upper - 1;
  const int last_column = view_.width[lower] - 1;
  const int last_row = view_.height[lower] - 1;
  for (int column = 0; column < view_.width[upper]; ++column) {
    std::uint8_t nearest = 255;
    for (const int y : {2 * row, std::min(2 * row + 2, last_row)}) {
      for (const int x : {2 * column, std::min(2 * column + 2, last_column)}) {
        nearest = std::min(nearest, storage_[lower][index_of(x, y, view_.width[lower])]);
      }
    }
    storage_[upper][index_of(column, row, view_.width[upper])] = nearest;
  }
}

}  // namespace picolo::inline v0
