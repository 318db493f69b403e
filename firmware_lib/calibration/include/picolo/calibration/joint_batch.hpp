// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Simultaneous calibration of wheel radii, track width and lidar pose (Censi et al. 2013), as
/// published: closed form, rounds of outlier rejection at a quantile, covariance. Several passes
/// over a re-readable source, no memory of samples.
#pragma once

#include <cstdint>

#include "picolo/calibration/motion_check.hpp"
#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

struct JointBatchConfig {
  int outlier_rounds = 4;  ///< 0: none
  /// A round drops samples whose translation or rotation error is strictly above the value at index
  /// floor(quantile n + 0.5) of the sorted errors.
  double quantile = 0.99;
  MotionNeeds needs{};
  double max_relative_std = 0.1;  ///< of radii and track width; above: refused
  double max_yaw_std_rad = 0.2;
  static constexpr int kMaxRounds = 8;
  [[nodiscard]] constexpr bool valid() const {
    return outlier_rounds >= 0 && outlier_rounds <= kMaxRounds && quantile > 0.5 &&
           quantile <= 1.0 && needs.valid() && max_relative_std > 0.0 && max_yaw_std_rad > 0.0;
  }
};

struct JointReport {
  DriveParameters drive{};
  RotationGain gain{};
  /// As published: noise from all samples but those of the first rejection, information from those
  /// that are left at the end. Conservative by a factor of about ten on logs with gross outliers.
  DriveMatrix covariance{};
  /// Noise and information both from the samples left at the end.
  DriveMatrix inlier_covariance{};
  Pose2d noise{};  ///< standard deviation of x, y, theta residuals of the samples left at the end
  double condition = 0.0;  ///< of the square-root information, columns scaled to unit length
  std::uint64_t samples = 0;
  std::uint64_t used = 0;
  Refusal refusal{};
};

/// Cost: 18 (rounds + 1) + 3 passes; one sin_cos a sample, pass and round.
/// State: under 3 KiB of stack.
/// Returns `invalid_argument` for a configuration that is not valid, `degenerate` with `refusal`
/// set when the drive cannot determine the parameters (`drive` then holds whatever could be
/// computed), else `ok`.
Status calibrate_joint(SampleSource<MotionSample>& source, const JointBatchConfig& config,
                       JointReport& report);

}  // namespace picolo::inline v0
