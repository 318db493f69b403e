// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the machine can do at best: the bare sums of Gauss-Newton on a bilinear grid, written by
/// hand for one thread. No robust kernel, no guards, no inlier count, one accumulator each; only
/// the arithmetic that nobody can leave out.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/undistort/undistorter.hpp"

namespace picolo::bench {

struct FloorSums {
  float xx, xy, xt, yy, yt, tt, bx, by, bt;
};

/// Precondition: every transformed point lies inside of the grid.
FloorSums floor_sums(const std::uint8_t* cells, int width, float cells_per_m, const Pose2f& pose,
                     const PointsView& points);

}  // namespace picolo::bench
