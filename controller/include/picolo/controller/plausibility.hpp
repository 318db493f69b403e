// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Well-formed samples that cannot be true: wheels faster than the vehicle, wheels and gyro that
/// turn differently.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/odometry/differential_drive.hpp"
#include "picolo/odometry/wheel_odometry.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

struct PlausibilityConfig {
  float max_wheel_speed_mps = 3.0F;  ///< a sample that asks for more is left out
  int max_left_out = 5;              ///< in a row; the next is taken as a restart of the counters
  float max_turn_difference_rad = 0.02F;  ///< between wheels and gyro, over about the time below
  Duration turn_memory = 100ms;
  Duration max_stamp_error = 20ms;  ///< between wheels and gyro; turns of this length prove nothing
  [[nodiscard]] constexpr bool valid() const {
    return max_wheel_speed_mps > 0.0F && max_left_out >= 0 && max_turn_difference_rad > 0.0F &&
           turn_memory > Duration{0} && max_stamp_error >= Duration{0};
  }
};

/// Leaves out samples with damaged counts: the next sound one covers their way too, so nothing is
/// lost.
/// Cost: O(1). Context: cycle only.
class WheelGate {
 public:
  WheelGate(const PlausibilityConfig& config, const DifferentialDriveConfig& drive);

  /// False: leave it out. May set `ticks.restarted`, when the counts went elsewhere and stayed
  /// there.
  [[nodiscard]] bool pass(WheelTicks& ticks);
  /// Samples left out since the start; never reset.
  [[nodiscard]] std::uint32_t left_out() const { return left_out_; }

 private:
  [[nodiscard]] bool believable(const WheelTicks& ticks) const;

  std::array<std::int64_t, 2> max_counts_per_s_{};
  int max_in_a_row_;
  int in_a_row_ = 0;
  WheelTicks last_{};
  bool has_last_ = false;
  std::uint32_t left_out_ = 0;
};

/// Compares how far wheels and gyro say the vehicle has turned, in a sum that forgets. A frozen
/// encoder, a frozen gyro and spinning wheels all show. Judges only while both speak. Cost: O(1).
/// Context: cycle only.
class TurnCheck {
 public:
  explicit TurnCheck(const PlausibilityConfig& config) : config_(config) {}

  /// Rate about the vehicle's own axis, bias removed.
  void add_gyro(Timestamp stamp, float rate_radps);
  void add(const WheelIncrement& increment);
  [[nodiscard]] bool disagrees() const { return disagrees_; }

 private:
  PlausibilityConfig config_;
  Timestamp last_gyro_{};
  float gyro_radps_ = 0.0F;
  float gyro_turn_rad_ = 0.0F;  // since the last increment of the wheels
  float difference_rad_ = 0.0F;
  bool has_gyro_ = false;
  bool disagrees_ = false;
};

}  // namespace picolo::inline v0
