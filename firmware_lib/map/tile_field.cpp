// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "tile_field.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "picolo/core/number_model.hpp"
#include "picolo/map/rolling_map.hpp"

namespace picolo::inline v0 {
namespace {

/// An obstacle `across` columns and `along` rows away.
struct Offset {
  std::uint8_t square;
  std::uint8_t across;
  std::uint8_t along;
};

constexpr int kSpan = kMaxFieldRadius + 1;

constexpr std::size_t count_offsets() {
  std::size_t count = 0;
  for (int i = 0; i < kSpan * kSpan; ++i) {
    const int square = (i / kSpan) * (i / kSpan) + (i % kSpan) * (i % kSpan);
    count += square < kMaxFieldRadius * kMaxFieldRadius ? 1 : 0;
  }
  return count;
}

/// Nearest first.
constexpr std::array<Offset, count_offsets()> offsets_by_distance() {
  std::array<Offset, count_offsets()> offsets{};
  std::size_t count = 0;
  for (int square = 0; square < kMaxFieldRadius * kMaxFieldRadius; ++square) {
    for (int i = 0; i < kSpan * kSpan; ++i) {
      const int across = i % kSpan;
      const int along = i / kSpan;
      if (across * across + along * along != square) { continue; }
      offsets[count] = {static_cast<std::uint8_t>(square), static_cast<std::uint8_t>(across),
                        static_cast<std::uint8_t>(along)};
      ++count;
    }
  }
  return offsets;
}

constexpr std::array<Offset, count_offsets()> kOffsets = offsets_by_distance();
constexpr std::uint32_t kWholeRow = (1U << kTileCells) - 1U;

/// A bit a cell, the tile's first column at bit `radius`. Word has as many bits as a tile with its
/// surroundings has columns.
template <typename Word>
using Rows = std::array<Word, kTileCells + 2 * kMaxFieldRadius>;

template <typename Word>
void read_rows(const TileRequest& request, Rows<Word>& rows) {
  const int corner = request.column - request.radius;
  const int first = std::max(0, corner);
  const int last = std::min(request.width, request.column + kTileCells + request.radius) - 1;
  const int below_occupied = request.occupied_from - 1;
  for (int row = 0; row < kTileCells + 2 * request.radius; ++row) {
    const int y = request.row - request.radius + row;
    Word bits = 0;
    if (y >= 0 && y < request.height) {
      const std::int8_t* const cells = request.occupancy + y * request.width;
      for (int x = last; x >= first; --x) {
        // The sign of the difference is the bit.
        const auto occupied = static_cast<std::uint32_t>(below_occupied - cells[x]) >> 31;
        bits = static_cast<Word>(bits << 1 | occupied);
      }
    }
    rows[static_cast<std::size_t>(row)] = static_cast<Word>(bits << (first - corner));
  }
}

/// `row` of the tile: rings of growing distance, until every column has met an obstacle.
template <typename Word>
void write_line(const Rows<Word>& rows, std::size_t row, const TileRequest& request,
                std::uint8_t* line) {
  const auto radius = static_cast<std::size_t>(request.radius);
  const std::uint8_t* const byte_of_square = request.byte_of_square.data();
  const std::size_t squares = radius * radius;
  std::array<Word, kSpan> both;  // by distance along, above and below together
  Word any = 0;
  for (std::size_t d = 0; d < radius; ++d) {
    both[d] = rows[row + radius - d] | rows[row + radius + d];
    any |= both[d];
  }
  std::fill(line, line + kTileCells, byte_of_square[squares]);
  if (any == 0) { return; }
  std::uint32_t left = kWholeRow;
  for (const Offset& offset : kOffsets) {
    if (offset.square >= squares) { return; }
    const Word seen = both[offset.along];
    std::uint32_t reached = static_cast<std::uint32_t>(seen >> (radius - offset.across)) |
                            static_cast<std::uint32_t>(seen >> (radius + offset.across));
    reached &= left;
    if (reached == 0) { continue; }
    left ^= reached;
    const std::uint8_t byte = byte_of_square[offset.square];
    for (; reached != 0; reached &= reached - 1) {
      line[static_cast<std::size_t>(std::countr_zero(reached))] = byte;
    }
    if (left == 0) { return; }
  }
}

template <typename Word>
void compute(const TileRequest& request) {
  Rows<Word> rows;
  read_rows(request, rows);
  for (int row = 0; row < kTileCells; ++row) {
    write_line(rows, static_cast<std::size_t>(row), request,
               request.field + (request.row + row) * request.width + request.column);
  }
}

}  // namespace

void compute_tile_field(const TileRequest& request) {
  if (kTileCells + 2 * request.radius <= 32) {
    compute<std::uint32_t>(request);
  } else {
    compute<std::uint64_t>(request);
  }
}

}  // namespace picolo::inline v0
