// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which way the surface runs at each point of a scan: a point on a wall says where the wall is
/// across, and nothing along it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

struct SurfaceConfig {
  /// A neighbour on each side at least this far away, or the last of `max_neighbours`.
  float reach_m = 0.20F;
  int max_neighbours = 8;
  /// The point may lie this far off the line between the two, ...
  float max_offset_m = 0.05F;
  float min_cosine = 0.95F;  ///< ... and the line may bend there by this angle
  [[nodiscard]] constexpr bool valid() const {
    return reach_m > 0.0F && max_neighbours > 0 && max_offset_m > 0.0F && min_cosine > 0.0F &&
           min_cosine < 1.0F;
  }
};
static_assert(SurfaceConfig{}.valid());

/// Directions along the surface, frame of the points, of length 127; (0, 0) where neighbours do not
/// make a straight line: corners, edges, thin and single things. Points in the order of bearing, as
/// measured. The first and the last point are not neighbours.
/// Cost: O(points * max_neighbours), about 60 instructions a point. Context: any.
void surface_directions(const PointsView& points, const SurfaceConfig& config,
                        std::span<std::int8_t> along_x, std::span<std::int8_t> along_y);

}  // namespace picolo::inline v0
