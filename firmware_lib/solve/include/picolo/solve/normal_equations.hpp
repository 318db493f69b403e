// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The 3x3 normal equations of planar matching, and their guarded solution.
#pragma once

#include <array>

#include "picolo/geometry/matrix3.hpp"

namespace picolo::inline v0 {

/// H dx = b with H = sum J'J, b = sum J' r, in (x, y, theta).
struct NormalEquations3 {
  Matrix3f h{};
  std::array<float, 3> b{};
};

/// How well a symmetric 3x3 information matrix determines x, y and theta, after theta was made
/// comparable to metres with a characteristic length (Zhang, Kaess, Singh 2016: eigenvalues in
/// common units).
struct Conditioning {
  std::array<float, 3> eigenvalues{};  ///< ascending, of the scaled matrix
  Matrix3f eigenvectors{};             ///< columns, same order, in scaled units
  float condition = 0.0F;  ///< largest over smallest eigenvalue; infinity when that is not positive
};

/// Eigenvalues of diag(1, 1, 1/length) * information * diag(1, 1, 1/length). Cost: about 3000
/// instructions.
[[nodiscard]] Conditioning conditioning_of(const Matrix3f& information, float length_m);

struct StepSolution {
  std::array<float, 3> step{};  ///< dx, dy (m), dtheta (rad)
  bool solved = false;          ///< false: H is not positive definite or not finite
};

/// Solves H dx = b by LDL'. Cost: about 600 instructions.
[[nodiscard]] StepSolution solve(const NormalEquations3& system);

/// Solves only along the eigenvectors whose eigenvalue is at least `largest / max_condition`; the
/// step has no component along the others (solution remapping of Zhang et al.). `solved` is false
/// when nothing is left.
[[nodiscard]] StepSolution solve_constrained(const NormalEquations3& system,
                                             const Conditioning& conditioning, float length_m,
                                             float max_condition);

/// How many of the three directions have an eigenvalue below `largest / max_condition`; 3 when none
/// is positive.
[[nodiscard]] int open_directions(const Conditioning& conditioning, float max_condition);

/// The same equations without what they say along the open directions: added to a prior, those are
/// the prior's alone (Zhang et al., solution remapping).
[[nodiscard]] NormalEquations3 observable_part(const NormalEquations3& system,
                                               const Conditioning& conditioning, float length_m,
                                               float max_condition);

/// Inverse of a symmetric positive definite matrix; identity times `otherwise` when it is not.
[[nodiscard]] Matrix3f covariance_of(const Matrix3f& information, float otherwise);

}  // namespace picolo::inline v0
