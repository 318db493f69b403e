// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How an IMU is turned about the vertical on its vehicle: accelerations it feels against those the
/// wheels tell. Single pass, constant memory.
#pragma once

#include <cstdint>

#include "picolo/calibration/parameter.hpp"
#include "picolo/core/status.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

/// Means over a short window, long enough that the wheels show an acceleration.
struct AccelerationWindow {
  double felt_x_mps2 = 0.0;  ///< IMU axes
  double felt_y_mps2 = 0.0;
  double forward_mps2 = 0.0;   ///< change of the vehicle's speed, over the window's length
  double leftward_mps2 = 0.0;  ///< speed times yaw rate
  double alpha_radps2 = 0.0;   ///< change of the yaw rate, over the window's length
  double omega2_radps2 = 0.0;  ///< square of the yaw rate
};

struct ImuMountConfig {
  std::uint64_t min_windows = 30;
  double max_yaw_std_rad = 0.05;
  double min_acceleration_mps2 = 0.05;  ///< root mean square over the drive; below: nothing to see
  [[nodiscard]] constexpr bool valid() const {
    return min_windows >= 4 && max_yaw_std_rad > 0.0 && min_acceleration_mps2 > 0.0;
  }
};

struct ImuMountReport {
  Estimate yaw_rad{};  ///< of base_T_imu
  /// Length of (cos, sin) before normalisation: 1 when wheels and IMU agree about accelerations.
  double scale = 0.0;
  double tilt_x_mps2 = 0.0;  ///< felt at rest: biases, and gravity on a tilted mount
  double tilt_y_mps2 = 0.0;
  double noise_mps2 = 0.0;
  std::uint64_t windows = 0;
  Refusal refusal{};
};

/// f = R(-yaw) (a + alpha k x r - omega^2 r) + tilt: linear in cos, sin, R(-yaw) r and tilt. State:
/// under 400 bytes. Cost: two rows of six a window. Context: one at a time.
class ImuMountCalibration {
 public:
  explicit ImuMountCalibration(const ImuMountConfig& config = {}) : config_(config) {}

  /// `invalid_argument`: not finite; not counted.
  Status add(const AccelerationWindow& window);
  /// `degenerate` with a refusal that names gyro_yaw.
  Status solve(ImuMountReport& report) const;
  void reset();

 private:
  ImuMountConfig config_;
  StreamingLeastSquares<6> system_;
  double squares_ = 0.0;  // of accelerations
  std::uint64_t windows_ = 0;
};

}  // namespace picolo::inline v0
