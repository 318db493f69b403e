// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The pyramid's one promise: a byte is no larger than any field byte of a window that begins in its
// square.

#include "picolo/map/max_pyramid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

std::vector<std::uint8_t> random_cells(std::uint64_t seed) {
  Random random{seed};
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(kWidth) * kHeight, 255);
  for (std::uint8_t& cell : cells) {
    if (random.below(20) == 0) { cell = static_cast<std::uint8_t>(random.below(255)); }
  }
  return cells;
}

DistanceFieldView view_of(const std::vector<std::uint8_t>& cells) {
  return {cells.data(), kWidth, kHeight, 20.0F, 0.5F};
}

std::uint8_t least_in(const std::vector<std::uint8_t>& cells, int x0, int y0, int size) {
  std::uint8_t least = 255;
  for (int y = std::max(0, y0); y < std::min(kHeight, y0 + size); ++y) {
    for (int x = std::max(0, x0); x < std::min(kWidth, x0 + size); ++x) {
      least = std::min(least, cells[static_cast<std::size_t>(y * kWidth + x)]);
    }
  }
  return least;
}

TEST(MaxPyramid, GivenAnyFieldWhenBuiltThenEachByteIsTheLeastOfItsDoubledSquare) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto cells = random_cells(seed);
    MaxPyramid<kWidth, kHeight, 3> pyramid;
    pyramid.core().begin(view_of(cells));
    ASSERT_TRUE(pyramid.core().step(1000));
    const MaxPyramidView& view = pyramid.view();
    ASSERT_EQ(view.levels, 3);
    for (std::size_t level = 0; level < 3; ++level) {
      const int size = MaxPyramidView::size_of(static_cast<int>(level));
      ASSERT_EQ(view.width[level], kWidth / size);
      ASSERT_EQ(view.height[level], kHeight / size);
      for (int row = 0; row < view.height[level]; ++row) {
        for (int column = 0; column < view.width[level]; ++column) {
          ASSERT_EQ(view.nearest[level][row * view.width[level] + column],
                    least_in(cells, column * size, row * size, 2 * size))
              << "level " << level << " square " << column << "," << row;
        }
      }
    }
  }
}

TEST(MaxPyramid, GivenAWindowAnywhereWhenLookedUpThenTheByteBoundsIt) {
  const auto cells = random_cells(9);
  MaxPyramid<kWidth, kHeight, 2> pyramid;
  pyramid.core().begin(view_of(cells));
  ASSERT_TRUE(pyramid.core().step(1000));
  for (std::size_t level = 0; level < 2; ++level) {
    const int size = MaxPyramidView::size_of(static_cast<int>(level));
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::uint8_t bound =
            pyramid.view().nearest[level][(y / size) * pyramid.view().width[level] + x / size];
        ASSERT_LE(bound, least_in(cells, x, y, size));
      }
    }
  }
}

TEST(MaxPyramid, GivenSlicesOfOneRowWhenSteppedThenTheResultIsTheSameAndCompletesInTime) {
  const auto cells = random_cells(4);
  MaxPyramid<kWidth, kHeight, 2> whole;
  MaxPyramid<kWidth, kHeight, 2> sliced;
  whole.core().begin(view_of(cells));
  ASSERT_TRUE(whole.core().step(1000));
  sliced.core().begin(view_of(cells));
  constexpr int kRows = kHeight / 4 + kHeight / 8;
  for (int i = 0; i + 1 < kRows; ++i) { ASSERT_FALSE(sliced.core().step(1)) << i; }
  ASSERT_FALSE(sliced.core().complete());
  ASSERT_TRUE(sliced.core().step(1));
  ASSERT_TRUE(sliced.core().complete());
  for (std::size_t level = 0; level < 2; ++level) {
    const int count = whole.view().width[level] * whole.view().height[level];
    EXPECT_TRUE(std::equal(whole.view().nearest[level], whole.view().nearest[level] + count,
                           sliced.view().nearest[level]));
  }
}

TEST(MaxPyramid, GivenTheRoomProfileWhenTwoLevelsThenItTakesFiveKibibytes) {
  constexpr std::size_t kBookkeeping = 256;
  EXPECT_LE(sizeof(MaxPyramid<256, 256, 2>), 5 * 1024 + kBookkeeping);
}

}  // namespace
}  // namespace picolo
