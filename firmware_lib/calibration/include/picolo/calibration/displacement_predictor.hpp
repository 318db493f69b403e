// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the lidar's displacement should be, learned from the first sample on: linear in four
/// numbers, so that it needs no solution.
#pragma once

#include <array>

#include "picolo/calibration/wheel_model.hpp"
#include "picolo/solve/normal_least_squares.hpp"

namespace picolo::inline v0 {

/// s = C n + (R(o) - 1) m: n is the mean wheel radius turned by the mounting yaw, m the lever arm
/// in lidar axes; n and m are free, which gives up the constraint between them but is determined as
/// far as the drive has gone: on the spot m alone. Cost of `add`: one sin_cos and 40
/// multiplications; of `refresh`: a 4x4 inverse. Context: one at a time.
class DisplacementPredictor {
 public:
  void reset();
  void add(const RotationGain& gain, const MotionSample& sample);
  /// Solves for what has been added, with a prior that keeps what has not been seen at zero.
  void refresh();

  struct Judgement {
    double x_m = 0.0;  ///< measured minus predicted
    double y_m = 0.0;
    double leverage =
        0.0;  ///< variance of the prediction over the variance of a measurement, mean of both axes
  };
  [[nodiscard]] Judgement judge(const RotationGain& gain, const MotionSample& sample) const;

 private:
  NormalLeastSquares system_{4};
  std::array<double, 4> solution_{};
  std::array<double, 16> covariance_{};
};

}  // namespace picolo::inline v0
