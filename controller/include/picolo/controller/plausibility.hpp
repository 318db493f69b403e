// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Well-formed samples that cannot be true: wheels faster than the vehicle, wheels and gyro that
/// turn differently.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/odometry/wheel_odometry.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

struct PlausibilityConfig {
  float max_wheel_speed_mps = 3.0F;  ///< a sample that asks for more is left out
  int max_left_out = 5;              ///< in a row; the next is taken as a restart of the counters
  float max_turn_difference_rad = 0.02F;  ///< between wheels and gyro, over about the time below
  Duration turn_memory = 200ms;
  Duration max_stamp_error = 20ms;  ///< between wheels and gyro; turns of this length prove nothing
  /// What a sensor shows by itself, see sensor_checks.hpp. Of a wheel, with ...
  float max_wheel_acceleration_mps2 = 10.0F;
  Duration max_stamp_jitter = 1ms;  ///< ... so uncertain stamps.
  float max_turn_acceleration_radps2 = 40.0F;
  float max_gyro_leap_radps = 0.15F;  ///< beyond that: noise and bumps
  /// A moving vehicle's gyro or accelerometer that repeats itself so long is stuck, the gyro when
  /// wheels and gyro have turned that much differently, too.
  Duration max_repetition = 150ms;
  float max_stuck_turn_rad = 0.005F;
  Duration doubt_hold = 300ms;       ///< how long one such finding is held against the sensor
  float max_gravity_error = 0.2F;    ///< share of 9.81 m/s^2; beyond it the accelerometer is wrong
  float max_vibration_mps2 = 10.0F;  ///< root of the mean square; more is no drive
  float max_shaking_mps2 = 0.5F;     ///< more than that against the mean: the vehicle moves
  float max_tilt_cosine = 0.9848F;   ///< of 10 deg; leaning further, a lidar sees the floor
  [[nodiscard]] constexpr bool valid() const {
    return max_wheel_speed_mps > 0.0F && max_left_out >= 0 && max_turn_difference_rad > 0.0F &&
           turn_memory > Duration{0} && max_stamp_error >= Duration{0} &&
           max_wheel_acceleration_mps2 > 0.0F && max_stamp_jitter >= Duration{0} &&
           max_turn_acceleration_radps2 > 0.0F && max_gyro_leap_radps > 0.0F &&
           max_repetition > Duration{0} && max_stuck_turn_rad >= 0.0F &&
           doubt_hold >= Duration{0} && max_gravity_error > 0.0F && max_vibration_mps2 > 0.0F &&
           max_shaking_mps2 > 0.0F && max_tilt_cosine > 0.0F && max_tilt_cosine <= 1.0F;
  }
};

/// Leaves out samples with damaged counts: the next sound one covers their way too, so nothing is
/// lost.
/// Cost: O(1). Context: cycle only.
class WheelGate {
 public:
  WheelGate(const PlausibilityConfig& config, const EncoderScale& encoders);

  /// False: leave it out. May set `ticks.restarted`, when the counts went elsewhere and stayed
  /// there.
  [[nodiscard]] bool pass(WheelTicks& ticks);
  /// Samples left out since the start; never reset.
  [[nodiscard]] std::uint32_t left_out() const { return left_out_; }
  /// Several in a row were: a bit for each encoder.
  [[nodiscard]] std::uint8_t suspects() const { return in_a_row_ > 1 ? suspects_ : 0; }

 private:
  [[nodiscard]] std::uint8_t unbelievable(const WheelTicks& ticks) const;

  std::array<std::int64_t, kMaxWheels> max_counts_per_s_{};  // 0: of an encoder without a wheel
  int max_in_a_row_;
  int in_a_row_ = 0;
  WheelTicks last_{};
  bool has_last_ = false;
  std::uint32_t left_out_ = 0;
  std::uint8_t suspects_ = 0;
};

/// Compares how far wheels and gyro say the vehicle has turned, in a sum that forgets. A frozen
/// encoder, a frozen gyro and spinning wheels all show. Judges only while both speak. Cost: O(1).
/// Context: cycle only.
class TurnCheck {
 public:
  /// `config` outlives the check.
  explicit TurnCheck(const PlausibilityConfig& config) : config_(config) {}
  explicit TurnCheck(PlausibilityConfig&& config) = delete;

  /// Rate about the vehicle's own axis, bias removed.
  void add_gyro(Timestamp stamp, float rate_radps);
  void add(const WheelIncrement& increment);
  [[nodiscard]] bool disagrees() const { return disagrees_; }
  /// By wheels, less by gyro; 0 unless both speak.
  [[nodiscard]] float difference_rad() const { return difference_rad_; }

 private:
  const PlausibilityConfig& config_;
  Timestamp last_gyro_{};
  float gyro_radps_ = 0.0F;
  float gyro_turn_rad_ = 0.0F;  // since the last increment of the wheels
  float difference_rad_ = 0.0F;
  bool has_gyro_ = false;
  bool disagrees_ = false;
};

}  // namespace picolo::inline v0
