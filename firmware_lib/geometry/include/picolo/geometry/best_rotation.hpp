// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The orthogonal Procrustes problem in space and in the plane: the rotation between two sets of
/// vectors (Arun, Huang, Blostein 1987), with the sign of Umeyama 1991 that never gives a
/// reflection.
#pragma once

#include "picolo/core/result.hpp"
#include "picolo/geometry/matrix3.hpp"

namespace picolo::inline v0 {

struct BestRotation {
  Matrix3d a_R_b = Matrix3d::identity();
  double trace{};  ///< trace(a_R_b^T C), the largest that a rotation reaches
};

/// a_R_b with the least sum of |a_i - a_R_b b_i|^2, from `correlation` C = sum of a_i b_i^T:
/// C = U S V^T, a_R_b = U diag(1, 1, det U det V) V^T. `degenerate`: C is not finite, or its second
/// singular value is at most `rank_tolerance` times the first (all vectors on one line). Cost: one
/// singular value decomposition of 3x3. Context: any.
[[nodiscard]] Result<BestRotation> best_rotation(const Matrix3d& correlation,
                                                 double rank_tolerance);

struct BestPlanarRotation {
  double cosine = 1.0;
  double sine = 0.0;
};

/// The same about z from the upper left 2x2 of `correlation`, where the decomposition has a closed
/// form: the direction of (c00 + c11, c10 - c01). `degenerate`: its length is at most
/// `rank_tolerance` times the norm of the 2x2 (all vectors in one place, or mirrored), or not
/// finite.
[[nodiscard]] Result<BestPlanarRotation> best_planar_rotation(const Matrix3d& correlation,
                                                              double rank_tolerance);

}  // namespace picolo::inline v0
