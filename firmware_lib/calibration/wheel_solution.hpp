// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From J21, J22 and b with their covariance to radii: shared by the batch and the single-pass
/// procedure.
#pragma once

#include "picolo/calibration/wheel_batch.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

/// What both stages left: rotation system, and the sums of the translation system [c] b = [s].
struct WheelSums {
  double cc = 0.0;  ///< sum of c_x^2 + c_y^2
  double cs = 0.0;
  double ss = 0.0;
};

/// Fills estimates, covariance and refusal. `degenerate` with a refusal when something is not
/// determined.
Status solve_wheels(const StreamingLeastSquares<2>& rotation, const WheelSums& translation,
                    const MotionCheck& check, const WheelBatchConfig& config, WheelReport& report);

}  // namespace picolo::inline v0
