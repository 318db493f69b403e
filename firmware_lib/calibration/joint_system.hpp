// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The second, constrained stage of the simultaneous calibration: rows q = (b, l_x, l_y, cos, sin),
/// |(cos, sin)| = 1.
#pragma once

#include <array>

#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// Symmetric 5x5, row-major: sum of row^T row.
using JointMatrix = std::array<double, 25>;

/// Adds the two rows of a sample: [-c_x, 1 - cos o, sin o, s_x, -s_y] and [-c_y, -sin o, 1 - cos o,
/// s_y, s_x].
void add_joint_rows(JointMatrix& m, const RotationGain& gain, const MotionSample& sample);

/// Minimises q^T M q under the constraint by the smallest eigenvector of the Schur complement on
/// (cos, sin); the sign makes b positive. `degenerate`: b, l_x and l_y are not determined, or b
/// vanishes.
Status solve_joint(const JointMatrix& m, const RotationGain& gain, DriveParameters& drive);

}  // namespace picolo::inline v0
