// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The lidar's yaw, then its x and y on a base whose odometry is right already. Single pass,
/// constant memory.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/samples.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

struct ExtrinsicConfig {
  /// Displacements that turn less than this give the yaw alone: there the lever arm does not
  /// matter.
  double max_straight_turn_rad = 0.02;
  double min_distance_m = 0.01;  ///< shorter displacements do not show a direction
  std::uint64_t min_samples = 10;
  double max_yaw_std_rad = 0.02;
  double max_position_std_m = 0.05;
  [[nodiscard]] constexpr bool valid() const {
    return max_straight_turn_rad > 0.0 && min_distance_m >= 0.0 && min_samples >= 3 &&
           max_yaw_std_rad > 0.0 && max_position_std_m > 0.0;
  }
};

struct ExtrinsicReport {
  Estimate yaw_rad{};  ///< of base_T_lidar; the rotation that takes an odometry displacement to a
                       ///< lidar displacement is its negative
  Estimate x_m{};      ///< of base_T_lidar
  Estimate y_m{};
  double yaw_scale = 0.0;  ///< length of (cos, sin) before normalisation: 1 when odometry and lidar
                           ///< agree about distances
  double condition = 0.0;  ///< of the system for cos, sin, x, y
  std::uint64_t straight = 0;
  std::uint64_t samples = 0;
  bool yaw_from_turns =
      false;  ///< too few straight displacements: the yaw came from all of them together with x, y
  Refusal yaw_refusal{};
  Refusal position_refusal{};
};

/// Yaw: [r_x -r_y; r_y r_x] [cos; sin] = [s_x; s_y] on straight displacements, theta = atan2(sin,
/// cos), yaw = -theta. Position: s = R(-yaw) (o + R(o) l - l) on all displacements, linear in (cos,
/// sin, R l), with the yaw put in. State: under 400 bytes. Cost: a few rows of two to four a
/// sample. Context: one at a time.
class ExtrinsicCalibration {
 public:
  explicit ExtrinsicCalibration(const ExtrinsicConfig& config = {}) : config_(config) {}
  /// `invalid_argument`: a number that is not finite.
  Status add(const MotionPair& pair);
  /// `degenerate`: the yaw is refused; a refused position alone is `ok`.
  Status solve(ExtrinsicReport& report) const;

 private:
  [[nodiscard]] Refusal judge_yaw() const;

  ExtrinsicConfig config_;
  StreamingLeastSquares<2> yaw_;
  StreamingLeastSquares<4> all_;  // cos, sin (of the yaw), x, y
  double travelled_m_ = 0.0;
  double turned_rad_ = 0.0;
  std::uint64_t straight_ = 0;
  std::uint64_t samples_ = 0;
};

}  // namespace picolo::inline v0
