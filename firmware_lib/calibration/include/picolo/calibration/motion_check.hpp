// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a drive has shown so far, in constant memory, and which parameter it leaves undetermined.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/samples.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// What a drive must have shown before its calibration is believed.
struct MotionNeeds {
  std::uint64_t samples = 30;
  double turn_each_way_rad = 1.5;  ///< heading swept to the left, and to the right
  double wheel_travel_rad = 6.0;   ///< rolled forwards or backwards, mean of both wheels
  double min_turn_rad = 0.3;       ///< less than this in all is no turn
  double min_arc_spread = 0.01;    ///< 1 - correlation^2 between speed and turn of the wheels
  bool both_directions = true;
  [[nodiscard]] constexpr bool valid() const {
    return samples >= 3 && turn_each_way_rad > 0.0 && wheel_travel_rad > 0.0 &&
           min_turn_rad > 0.0 && min_arc_spread >= 0.0 && min_arc_spread < 1.0;
  }
};

/// Sums the heading swept each way; swings below the threshold are noise and count for nothing.
class SwingMeter {
 public:
  explicit SwingMeter(double threshold) : threshold_(threshold) {}
  void add(double change);
  [[nodiscard]] double positive() const;
  [[nodiscard]] double negative() const;

 private:
  double threshold_;
  double rise_ = 0.0;  // above the lowest, below the highest value before the first swing
  double fall_ = 0.0;
  double back_ = 0.0;
  double positive_ = 0.0;
  double negative_ = 0.0;
  int direction_ = 0;
};

/// Gathers the statistics that tell a sufficient drive from an insufficient one. State: about 250
/// bytes whatever the drive's length. Cost: O(1) a sample. Context: one at a time.
class MotionCheck {
 public:
  MotionCheck() = default;
  void add(const MotionSample& sample);

  /// The first thing that is missing, most basic first; none when the drive suffices.
  [[nodiscard]] Refusal judge(const MotionNeeds& needs) const;
  /// Least squares of the rotation alone; `degenerate` as long as the wheels do not vary.
  Status rotation_gain(RotationGain& gain) const;
  /// The same with a prior of the given information on each gain (1 / variance in units of the
  /// rotation's noise), and the covariance for unit noise, row-major. Always determined.
  /// Precondition: information > 0.
  void gain_with_prior(const RotationGain& prior, double information, RotationGain& gain,
                       std::array<double, 4>& covariance) const;
  /// Share of the rotation's variance that the wheels explain, 0..1.
  [[nodiscard]] double explained_rotation() const;
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] double turned_left_rad() const { return heading_.positive(); }
  [[nodiscard]] double turned_right_rad() const { return heading_.negative(); }
  /// Mean of both wheels, forwards plus backwards.
  [[nodiscard]] double wheel_travel_rad() const;
  [[nodiscard]] double lidar_travel_m() const { return lidar_travel_m_; }
  /// 1 - correlation^2 between speed and turn of the wheels: 0 on one constant arc.
  [[nodiscard]] double arc_spread() const;

  /// Energy of the sum of both wheels in that of sum and difference: 1 straight ahead, 0 on the
  /// spot.
  [[nodiscard]] double speed_share() const;

 private:
  [[nodiscard]] Refusal judge_encoders() const;

  std::uint64_t samples_ = 0;
  double left_rad_ = 0.0;  // absolute sums
  double right_rad_ = 0.0;
  double ll_ = 0.0, lr_ = 0.0, rr_ = 0.0;
  double lt_ = 0.0, rt_ = 0.0, tt_ = 0.0;
  double lidar_travel_m_ = 0.0;
  SwingMeter heading_{0.15};
  SwingMeter wheels_{0.5};
};

}  // namespace picolo::inline v0
