// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The motion between two sets of points with known correspondences, in closed form (Arun, Huang,
/// Blostein 1987, "Least-squares fitting of two 3-D point sets"), with the sign fix that keeps a
/// rotation where the best orthogonal matrix is a reflection (Umeyama 1991).
#pragma once

#include <span>

#include "picolo/core/result.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0 {

/// a_T_b with the least sum of |a_p[i] - a_T_b * b_p[i]|^2.
/// `invalid_argument`: spans of different length, or fewer than 2 (3D: 3) points. `degenerate`: the
/// points do not determine the rotation (all in one place; in 3D: on one line) or are not finite.
/// Cost: O(points), one singular value decomposition, in double.
[[nodiscard]] Result<Pose2d> align_points(std::span<const Point2<double>> a_p,
                                          std::span<const Point2<double>> b_p);
[[nodiscard]] Result<Transform3d> align_points(std::span<const Vector3d> a_p,
                                               std::span<const Vector3d> b_p);

}  // namespace picolo::inline v0
