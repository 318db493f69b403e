// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Direct linear odometry calibration: scan = X odom with X 3x3. Single pass, constant memory, any
/// number of samples.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/samples.hpp"
#include "picolo/geometry/matrix3.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

struct LinearReport {
  Matrix3d correction = Matrix3d::identity();  ///< X
  Matrix3d deviation{};                        ///< standard deviation of each entry
  std::array<double, 81> covariance{};         ///< of the nine entries, row-major in X
  double condition = 0.0;
  std::uint64_t samples = 0;
  double rms_before_m = 0.0;  ///< of translation, scan against odom
  double rms_after_m = 0.0;
  Refusal refusal{};
};

/// Rows [o 0 0], [0 o 0], [0 0 o] of A and the scan's x, y, theta as b. Odometry of a differential
/// drive has little or no y in its own frame: a column without information is not determined by the
/// data and, if `keep_unobserved`, keeps the identity's entries. State: under 1 KiB. Cost: three
/// rows of nine a sample. Context: one at a time.
class LinearCalibration {
 public:
  /// `invalid_argument`: a number that is not finite; the sample is not counted.
  Status add(const MotionPair& pair);
  /// `degenerate` with a refusal: fewer than 10 samples, or a column that the data does not
  /// determine.
  Status solve(LinearReport& report, bool keep_unobserved = true) const;
  [[nodiscard]] std::uint64_t samples() const { return samples_; }

 private:
  StreamingLeastSquares<9> system_;
  std::array<double, 3> column_squares_{};
  double before_squares_ = 0.0;
  std::array<double, 3> scan_squares_{};
  std::uint64_t samples_ = 0;
};

}  // namespace picolo::inline v0
