// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bias of a yaw gyro at standstill, and its scale against the lidar. Single pass, constant memory.
#pragma once

#include <cstdint>

#include "picolo/calibration/parameter.hpp"
#include "picolo/core/status.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

struct GyroCalibrationConfig {
  std::uint64_t min_standing = 100;  ///< samples at standstill
  /// A larger mean rate at standstill is no bias: somebody turns the vehicle.
  double max_bias_radps = 0.15;
  double max_bias_std_radps = 0.002;
  std::uint64_t min_turns = 30;  ///< intervals seen by gyro and lidar
  double min_turned_rad = 3.0;   ///< in all of them, both ways
  double max_scale_std = 0.01;
  [[nodiscard]] constexpr bool valid() const {
    return min_standing >= 2 && max_bias_radps > 0.0 && max_bias_std_radps > 0.0 &&
           min_turns >= 4 && min_turned_rad > 0.0 && max_scale_std > 0.0;
  }
};

/// true rate = scale * (measured rate - bias)
struct GyroReport {
  Estimate bias_radps{};
  Estimate scale{};
  /// What the bias moved by while driving, in true rate; scale does not depend on it.
  double drift_radps = 0.0;
  double noise_rad = 0.0;  ///< of one interval, gyro against lidar
  std::uint64_t standing = 0;
  std::uint64_t turns = 0;
  std::uint64_t rejected = 0;
  Refusal bias_refusal{};
  Refusal scale_refusal{};
};

/// Turns are gated by the running median of their residuals once twenty have been seen: a wrong
/// match moves nothing. State: under 400 bytes. Cost: O(1) a call. Context: one at a time.
class GyroCalibration {
 public:
  explicit GyroCalibration(const GyroCalibrationConfig& config = {}) : config_(config) {}

  /// A rate measured while the wheels stand. Not finite: left out.
  void add_standing(double rate_radps);
  /// `gyro_rad`: integral of the measured rate, bias and all, over the time in which the lidar
  /// turned by `lidar_rad`. `invalid_argument`: not finite, or no duration.
  Status add_turn(double gyro_rad, double duration_s, double lidar_rad);
  /// `degenerate`: bias or scale is refused.
  Status solve(GyroReport& report) const;
  /// Forgets the turns; the standstill remains.
  void forget_turns();
  void reset();

 private:
  [[nodiscard]] bool passes(double gyro_rad, double duration_s, double lidar_rad);

  GyroCalibrationConfig config_;
  std::uint64_t standing_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
  StreamingLeastSquares<2> turns_;  // scale, drift
  double turned_rad_ = 0.0;
  double median_rad_ = 0.0;
  std::uint64_t rejected_ = 0;
};

}  // namespace picolo::inline v0
