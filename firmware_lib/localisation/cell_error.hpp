// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far walls may be off because a map knows cells only. Private to localisation.
#pragma once

#include "picolo/geometry/matrix3.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

/// Covariance of the sum of the points' gradients (x, y, theta about the vehicle, window axes) by
/// where walls lie in their cells, for points of unit information; m^2.
///
/// A wall whose slope is a fraction of small numbers, k/h, meets its cells in the same way again
/// and again: all its points err together by up to 1 / |(h, k)| of a cell, a saw tooth of its place
/// across. In waves: each multiple of (h, k) over the cell's size adds
/// cell^2 / (2 pi^2 |multiple|^2) times the squared sum of the points' gradients, each with the
/// wave's phase at the point. Walls that cross their cells evenly cancel; stairs a few metres long
/// turn the sum. Where all walls run the same way the sweep itself turns with such a stair, and its
/// phases no longer tell of it: there the waves are summed as well for a wall that is turned by one
/// stair over all that is seen, either way. Neighbours on a wall, nine at a time, stand for one
/// place.
/// Cost: O(points), about 110 instructions a point. Context: cycle only.
[[nodiscard]] Matrix3f cell_error(const PointsView& points, const MatchReport& report,
                                  float cell_m);

}  // namespace picolo::inline v0
