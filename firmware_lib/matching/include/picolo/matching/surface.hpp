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
  int max_neighbours = 12;
  /// The point may lie this far off the line between the two, ...
  float max_offset_m = 0.05F;
  float min_cosine = 0.95F;  ///< ... and the line may bend there by this angle
  /// Where a straight line of hits ends so far from the next but last, that hit is no edge: the
  /// wall runs on, its next beam just met nothing.
  float sparse_m = 0.6F;
  [[nodiscard]] constexpr bool valid() const {
    return reach_m > 0.0F && max_neighbours > 0 && max_offset_m > 0.0F && min_cosine > 0.0F &&
           min_cosine < 1.0F && sparse_m > 0.0F;
  }
};
static_assert(SurfaceConfig{}.valid());

/// Directions along the surface, frame of the points, of length 127; (0, 0) where neighbours do not
/// make a straight line: corners, edges, thin and single things. The last hit on a wall that runs
/// away, `reach_m` and more from its neighbour, takes the direction of that side: it is no edge,
/// the next beam just met nothing. Points in the order of bearing, as measured. The first and the
/// last point are not neighbours.
/// Cost: O(points * max_neighbours), about 90 instructions a point. Context: any.
void surface_directions(const PointsView& points, const SurfaceConfig& config,
                        std::span<std::int8_t> along_x, std::span<std::int8_t> along_y);

}  // namespace picolo::inline v0
