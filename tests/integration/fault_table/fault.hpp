// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a judge may inject into the stream of one sensor, and when.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "picolo/core/random.hpp"
#include "picolo/core/time.hpp"

namespace picolo::test {

enum class Sensor : std::uint8_t { left_wheel, right_wheel, lidar, gyro, accelerometer };
inline constexpr std::array<const char*, 5> kSensorNames{"left wheel", "right wheel", "lidar",
                                                         "gyro", "accelerometer"};

enum class Kind : std::uint8_t { off, stuck, garbage, wrong_scale, slow, delayed, intermittent };
inline constexpr std::array<const char*, 7> kKindNames{
    "off", "stuck", "garbage", "wrong scale", "slow", "delayed", "intermittent"};

/// One fault; what the kind leaves open is drawn from `seed`: docs/faults.md says how.
struct Fault {
  Sensor sensor = Sensor::lidar;
  Kind kind = Kind::off;
  Timestamp begin = Timestamp::max();  ///< inclusive
  Timestamp end = Timestamp::max();
  std::uint64_t seed = 0;
};

/// The fault of a device's stream, sample by sample. Stamps asked for must not decrease.
class FaultState {
 public:
  void set(const Fault& fault) {
    fault_ = fault;
    random_ = Random{fault.seed, 3};
    second_variant_ = random_.below(2) == 1;
    const double size = random_.uniform(std::log(1.1), std::log(2.0));
    scale_ = std::exp(random_.below(2) == 1 ? size : -size);
    every_ = (fault.sensor == Sensor::lidar ? 2 : 4) + static_cast<int>(random_.below(6));
    delay_ = Duration{50'000 + random_.below(250'000)};
    next_change_ = fault.begin;
    gone_ = false;
  }

  [[nodiscard]] bool is(Sensor sensor, Kind kind, Timestamp stamp) const {
    return fault_.sensor == sensor && fault_.kind == kind && stamp >= fault_.begin &&
           stamp < fault_.end;
  }
  [[nodiscard]] bool holds(Sensor sensor, Timestamp stamp) const {
    return fault_.sensor == sensor && stamp >= fault_.begin && stamp < fault_.end;
  }
  /// Whether an intermittent sensor is gone: bursts of 20 to 500 ms.
  [[nodiscard]] bool gone(Timestamp stamp) {
    while (stamp >= next_change_) {
      gone_ = !gone_;
      next_change_ += Duration{20'000 + random_.below(480'000)};
    }
    return gone_;
  }

  [[nodiscard]] const Fault& fault() const { return fault_; }
  [[nodiscard]] bool second_variant() const { return second_variant_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] int every() const { return every_; }
  [[nodiscard]] Duration delay() const { return delay_; }
  [[nodiscard]] Random& random() { return random_; }

 private:
  Fault fault_{};
  Random random_{0, 3};
  bool second_variant_ = false;
  double scale_ = 1.0;
  int every_ = 1;
  Duration delay_{};
  Timestamp next_change_ = Timestamp::max();
  bool gone_ = false;
};

}  // namespace picolo::test
