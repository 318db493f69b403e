// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The direct linear calibration with rounds of outlier rejection, for displacements whose scan
/// matches are sometimes wrong. Several passes over a re-readable source, no memory of samples.
#pragma once

#include <cstdint>

#include "picolo/calibration/linear_calibration.hpp"
#include "picolo/calibration/samples.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

struct LinearBatchConfig {
  int outlier_rounds = 2;
  /// A round drops what is above this quantile of all translation or rotation errors against the
  /// matrix so far.
  double quantile = 0.8;
  [[nodiscard]] constexpr bool valid() const {
    return outlier_rounds >= 0 && outlier_rounds <= 8 && quantile > 0.5 && quantile <= 1.0;
  }
};

/// X o. The result's theta is not wrapped.
[[nodiscard]] Pose2d corrected_by(const Matrix3d& correction, const Pose2d& odometry);

/// Cost: 17 passes a round and one more. State: under 2 KiB. `invalid_argument`: the
/// configuration; else as LinearCalibration::solve.
Status calibrate_linear(SampleSource<MotionPair>& source, const LinearBatchConfig& config,
                        LinearReport& report);

}  // namespace picolo::inline v0
