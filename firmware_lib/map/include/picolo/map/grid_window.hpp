// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where the rolling window of a grid lies in the map.
#pragma once

#include <cstdint>

#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

/// A rectangle of `width` x `height` square cells whose lower left corner is a whole number of
/// cells from the map's origin. Window coordinates are metres from that corner, axes parallel to
/// the map's: small enough for float.
struct GridWindow {
  int width = 0;
  int height = 0;
  float cell_m = 0.05F;
  std::int32_t origin_x_cells = 0;
  std::int32_t origin_y_cells = 0;

  [[nodiscard]] friend constexpr bool operator==(const GridWindow&, const GridWindow&) = default;
};

/// The same pose (or point) relative to the window, and back. Cost: O(1).
[[nodiscard]] Pose2f to_window(const GridWindow& window, const Pose2d& map_T_base);
[[nodiscard]] Pose2d to_map(const GridWindow& window, const Pose2f& window_T_base);

}  // namespace picolo::inline v0
