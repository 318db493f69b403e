// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Streams that contradict themselves, whatever the other sensors say: wheels that change their
/// speed at once, sensors that repeat themselves while the vehicle drives, gravity that is none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/controller/plausibility.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

/// How sensors are numbered in the event `sensor_doubted`; a bit each in SensorDoubts.
enum class SensorIndex : std::uint8_t { left_wheel, right_wheel, lidar, gyro, accelerometer };
inline constexpr std::size_t kSensorCount = 5;

/// Sensors in doubt, one bit each.
using SensorDoubts = std::uint8_t;
[[nodiscard]] constexpr SensorDoubts doubt_of(SensorIndex sensor) {
  return static_cast<SensorDoubts>(1U << static_cast<unsigned>(sensor));
}

/// A wheel has the vehicle's mass on it: its speed does not change at once. A counter that sticks,
/// jumps, hesitates or begins to count wrongly does. Cost: O(1). Context: cycle only.
class WheelStepCheck {
 public:
  WheelStepCheck(const PlausibilityConfig& config, const EncoderScale& encoders);

  /// Every sample that the gate has passed. Encoders whose wheel changed its speed faster than it
  /// can, a bit each.
  [[nodiscard]] std::uint8_t add(const WheelTicks& ticks);

 private:
  std::array<float, kMaxWheels> counts_per_m_{};  // 0: of an encoder without a wheel
  float max_acceleration_mps2_;
  float stamp_jitter_s_;
  WheelTicks last_{};
  std::array<float, kMaxWheels> rate_counts_per_s_{};
  bool has_last_ = false;
  bool has_rate_ = false;
};

using Axes = std::array<float, 3>;

/// The newest sample of three axes, and how long they have repeated themselves to the bit while the
/// vehicle moved. Cost: O(1). Context: cycle only.
class AxesStream {
 public:
  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] Timestamp stamp() const { return stamp_; }
  [[nodiscard]] const Axes& newest() const { return newest_; }
  /// A sample later than the newest. For how long the same has come, without a gap; 0 at a change.
  Duration add(Timestamp stamp, const Axes& axes, bool moving);

 private:
  Timestamp stamp_{};
  Timestamp changed_{};
  Axes newest_{};
  bool started_ = false;
};

/// A gyro that repeats itself to the bit while the vehicle turns otherwise, or whose rate leaps.
/// Repetition alone proves nothing: a coarse gyro says 0 all along a straight way. Cost: O(1).
/// Context: cycle only.
class GyroCheck {
 public:
  /// `config` outlives the check.
  explicit GyroCheck(const PlausibilityConfig& config) : config_(config) {}
  explicit GyroCheck(PlausibilityConfig&& config) = delete;

  /// `moving`: the wheels are. `turn_difference_rad`: TurnCheck's. True: doubtful.
  [[nodiscard]] bool add(const ImuSample& sample, bool moving, float turn_difference_rad);

 private:
  const PlausibilityConfig& config_;
  AxesStream rate_radps_;
};

/// A lidar whose revolution repeats the one before to the bit. Cost: O(1). Context: cycle only.
class SweepCheck {
 public:
  void add(const RangeReading& reading);
  /// The last complete revolution was that of before; some of its returns were real.
  [[nodiscard]] bool repeats() const { return repeats_; }

 private:
  void compare();

  static constexpr std::uint32_t kNothing = 2'166'136'261U;  // FNV-1a
  std::uint32_t hash_ = kNothing;
  std::uint32_t last_hash_ = kNothing;
  std::uint16_t returns_ = 0;
  bool repeats_ = false;
};

/// What the accelerometer is for: whether the vehicle leans, whether it shakes, and whether the
/// accelerometer itself can be believed. Cost: O(1). Context: cycle only.
class GravityCheck {
 public:
  /// `config` outlives the check.
  explicit GravityCheck(const PlausibilityConfig& config) : config_(config) {}
  explicit GravityCheck(PlausibilityConfig&& config) = delete;

  /// `moving`: the wheels are. Upright is how it stood at first.
  void add(const ImuSample& sample, bool moving);
  /// Leans by more than configured against how it stood: the lidar's plane does too.
  [[nodiscard]] bool tilted() const { return tilted_; }
  /// Is shaken or accelerated: wheels that stand do not mean that the vehicle does.
  [[nodiscard]] bool shaken() const { return shaken_; }
  /// Repeats itself while the vehicle moves, is no gravity at all, or noise.
  [[nodiscard]] bool doubtful() const { return doubtful_; }

 private:
  const PlausibilityConfig& config_;
  AxesStream acceleration_mps2_;
  Axes mean_{};
  Axes upright_{};
  float variance_ = 0.0F;
  std::uint16_t upright_samples_ = 0;
  bool tilted_ = false;
  bool shaken_ = false;
  bool doubtful_ = false;
};

}  // namespace picolo::inline v0
