// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The wheel model in one pass and constant memory: b from moments that are polynomials in J21,
/// J22.
#pragma once

#include <array>

#include "picolo/calibration/motion_check.hpp"
#include "picolo/calibration/wheel_batch.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/calibration/wheel_walk.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

/// Takes the stretches that `WheelWalk` delivers, in their order. State: under 1 KiB whatever their
/// number. Cost: one sin_cos and about 60 multiplications a stretch. Context: one at a time.
class WheelStreaming {
 public:
  /// `guess`: where the polynomials are first expanded; 20 % off is no harm.
  explicit WheelStreaming(const WheelBatchConfig& config = {},
                          const RotationGain& guess = {-0.2, 0.2})
      : config_(config), reference_(guess) {}
  void add(const WheelStretch& stretch, const ScanMotion& scan);
  /// As calibrate_wheels.
  Status solve(WheelReport& report) const;

 private:
  void close(const ScanMotion& scan);

  WheelBatchConfig config_;
  RotationGain reference_;
  StreamingLeastSquares<2> rotation_;
  MotionCheck check_{};
  double left_rad_ = 0.0;  // of the open interval
  double right_rad_ = 0.0;
  std::array<double, 6> heading_{};
  std::array<double, 6> x_{};
  std::array<double, 6> y_{};
  std::array<double, 6> cc_{};
  std::array<double, 6> cs_{};
  double ss_ = 0.0;
};

}  // namespace picolo::inline v0
