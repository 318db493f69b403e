// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Upper bounds of a likelihood field over squares of cells: what branch and bound prunes with
/// (Hess, Kohler, Rapp, Andor 2016, section V), decimated so that it costs a twelfth of the field.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/map/likelihood_field.hpp"

namespace picolo::inline v0 {

inline constexpr int kMaxPyramidLevels = 3;
inline constexpr int kPyramidBaseCells = 4;  ///< side of the squares of level 0; doubles by level

/// Level l holds, for each square of `size = 4 << l` cells aligned to `size`, the least byte of the
/// field in the square of twice that side that begins at the same corner. So one byte bounds every
/// placement within `size` x `size` cells, wherever that window begins inside of the aligned
/// square.
struct MaxPyramidView {
  int levels = 0;
  std::array<const std::uint8_t*, kMaxPyramidLevels> nearest{};  ///< row-major
  std::array<int, kMaxPyramidLevels> width{};
  std::array<int, kMaxPyramidLevels> height{};
  [[nodiscard]] static constexpr int size_of(int level) { return kPyramidBaseCells << level; }
};

/// Built from a field in bounded slices. The bounds hold for the field as it was when its rows were
/// read: let it rest, or build anew, before an exact answer is needed. Context: cycle only.
class MaxPyramidCore {
 public:
  /// Precondition: width and height multiples of the size of the last level; storage[l] of width *
  /// height / size_of(l)^2 bytes.
  MaxPyramidCore(int width, int height, int levels,
                 const std::array<std::span<std::uint8_t>, kMaxPyramidLevels>& storage);

  /// Starts over. Precondition: the field has the pyramid's width and height and lives until the
  /// last step.
  void begin(const DistanceFieldView& field);
  /// Computes up to `max_rows` more rows; true when the pyramid is complete. Cost: about 350
  /// instructions a square of level 0, 10 of the others.
  bool step(int max_rows);
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] const MaxPyramidView& view() const { return view_; }

 private:
  void build_base_row(int row);
  void build_upper_row(int level, int row);

  std::array<std::span<std::uint8_t>, kMaxPyramidLevels> storage_;
  MaxPyramidView view_{};
  DistanceFieldView field_{};
  int level_ = 0;
  int row_ = 0;
  bool complete_ = false;
};

/// Storage: width * height * (1/16 + 1/64 ...) bytes; 5 KiB for 256 x 256 cells and two levels.
template <int Width, int Height, int Levels = 2>
class MaxPyramid {
  static_assert(Levels >= 1 && Levels <= kMaxPyramidLevels);
  static_assert(Width % MaxPyramidView::size_of(Levels - 1) == 0 &&
                Height % MaxPyramidView::size_of(Levels - 1) == 0);
  static constexpr std::size_t bytes(int level) {
    return level < Levels ? static_cast<std::size_t>(Width / MaxPyramidView::size_of(level)) *
                                static_cast<std::size_t>(Height / MaxPyramidView::size_of(level))
                          : 0;
  }

 public:
  MaxPyramid() : core_(Width, Height, Levels, {first_, second_, third_}) {}
  MaxPyramid(const MaxPyramid&) = delete;
  MaxPyramid& operator=(const MaxPyramid&) = delete;
  ~MaxPyramid() = default;

  [[nodiscard]] MaxPyramidCore& core() { return core_; }
  [[nodiscard]] const MaxPyramidView& view() const { return core_.view(); }

 private:
  std::array<std::uint8_t, bytes(0)> first_{};
  std::array<std::uint8_t, bytes(1)> second_{};
  std::array<std::uint8_t, bytes(2)> third_{};
  MaxPyramidCore core_;
};

}  // namespace picolo::inline v0
