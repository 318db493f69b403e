// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Fisher information of the six parameters, and what follows from it.
#pragma once

#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// Jacobian^T diag(1 / sigma^2) Jacobian of a sample's x, y, theta, added to the sum.
void add_information(DriveMatrix& information, const DriveJacobian& jacobian, const Pose2d& sigma);

/// Covariance and the condition number of the square-root information with columns scaled to unit
/// length. `degenerate`: the information is singular.
Status covariance_of(const DriveMatrix& information, DriveMatrix& covariance, double& condition);

/// Mean and spread of x, y, theta residuals.
class ResidualMoments {
 public:
  void add(const Pose2d& residual);
  /// Sample standard deviations (n - 1), mean removed; never below 1e-12.
  [[nodiscard]] Pose2d standard_deviation() const;

 private:
  double count_ = 0.0;
  Pose2d mean_{};
  Pose2d squares_{};
};

}  // namespace picolo::inline v0
