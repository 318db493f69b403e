// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Two driven wheels on one axle.
#pragma once

#include "picolo/geometry/matrix3.hpp"
#include "picolo/odometry/wheel_odometry.hpp"

namespace picolo::inline v0 {

/// Base is the middle of the axle, x forward.
struct DifferentialDriveConfig {
  double left_radius_m = 0.1;
  double right_radius_m = 0.1;
  double track_m = 0.5;                   ///< distance of the wheels' contact points
  double counts_per_revolution = 4096.0;  ///< of a wheel, gear included
  /// X of the direct linear calibration (calibration/linear_calibration.hpp): what the model above
  /// says of (x, y, theta) is multiplied by it, increment by increment.
  Matrix3d correction = Matrix3d::identity();
  [[nodiscard]] constexpr bool valid() const {
    return left_radius_m > 0.0 && right_radius_m > 0.0 && track_m > 0.0 &&
           counts_per_revolution > 0.0;
  }
};

/// Exact for constant wheel speeds between samples: the arc is the exponential of (mean path, 0,
/// difference / track); a correction that is not the identity multiplies the increment. Cost: one
/// sin_cos in double. Context: cycle only.
class DifferentialDrive {
 public:
  explicit DifferentialDrive(const DifferentialDriveConfig& config = {});

  Result<WheelIncrement> update(const WheelTicks& ticks);
  [[nodiscard]] WheelJacobian jacobian() const;
  [[nodiscard]] EncoderScale encoder_scale() const;
  [[nodiscard]] const DifferentialDriveConfig& config() const { return config_; }

 private:
  DifferentialDriveConfig config_;
  bool corrected_;
  Tangent2<double> path_{};  // of the last increment
  WheelTicks last_{};
  bool has_last_ = false;
};

}  // namespace picolo::inline v0
