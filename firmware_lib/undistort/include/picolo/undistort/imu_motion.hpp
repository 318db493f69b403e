// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The motion within a sweep from an IMU: its turn from the gyro, its translation from a velocity
/// that somebody else knows (wheels, the last match) and, when asked for, the accelerometer.
#pragma once

#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/undistort/pose_buffer.hpp"

namespace picolo::inline v0 {

struct ImuMotionConfig {
  float gyro_sign = 1.0F;   ///< -1 for a sensor mounted upside down
  Duration max_gap = 50ms;  ///< after a longer silence the poses begin anew: nobody knows what was
  bool use_accelerometer = false;  ///< doubly integrated, so poor after a second; level ground only
  [[nodiscard]] constexpr bool valid() const {
    return max_gap > Duration{0} && (gyro_sign == 1.0F || gyro_sign == -1.0F);
  }
};
static_assert(ImuMotionConfig{}.valid());

/// Feeds a pose buffer with one pose an IMU sample: the trapezoid of the rate, the arc of constant
/// velocity in base. Good for the duration of a sweep; over longer times it drifts. Cost: O(1).
/// Context: cycle only.
class ImuMotion {
 public:
  explicit ImuMotion(const ImuMotionConfig& config = {}) : config_(config) {}

  /// What the gyro shows at rest; subtracted from the next sample on.
  void set_bias(float rate_radps) { bias_radps_ = rate_radps; }
  /// Velocity of base in base, m/s; holds until the next call (or is carried on by the
  /// accelerometer).
  void set_velocity(float x_mps, float y_mps);
  /// `out_of_range`: not newer than the last sample; nothing changed. `invalid_argument`:
  /// saturated, or not a number; nothing changed.
  Status add(const ImuSample& sample, PoseBufferCore& poses);

  [[nodiscard]] const StampedPose& pose() const { return pose_; }
  [[nodiscard]] std::uint32_t gaps() const { return gaps_; }

 private:
  ImuMotionConfig config_;
  StampedPose pose_{};
  float bias_radps_ = 0.0F;
  double last_rate_radps_ = 0.0;
  double velocity_x_mps_ = 0.0;
  double velocity_y_mps_ = 0.0;
  std::uint32_t gaps_ = 0;
  bool started_ = false;
};

}  // namespace picolo::inline v0
