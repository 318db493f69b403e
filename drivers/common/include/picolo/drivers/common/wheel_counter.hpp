// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From an encoder's position, which wraps and restarts, to a count that never does.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

struct WheelCounterConfig {
  /// The position wraps here: 2^32 for CiA 402 counters, the total range (object 0x6002) of an
  /// absolute encoder. 2 to 2^32, any number.
  std::uint64_t modulus = std::uint64_t{1} << 32;
  bool inverted = false;  ///< the encoder counts down while the wheel rolls forward
  /// Fastest believable motion; a step beyond it is a restart that nobody announced. 0 = not known,
  /// believe all.
  std::uint32_t max_counts_per_s = 0;
  /// When the speed limit is not known and the modulus is below 2^32: a silence longer than this
  /// makes a step ambiguous.
  Duration max_silence = 500ms;
  [[nodiscard]] constexpr bool valid() const {
    return modulus >= 2 && modulus <= (std::uint64_t{1} << 32) && max_silence > Duration{0};
  }
};

/// One wheel. Starts at 0 with the first position. Cost: O(1). Context: one at a time.
class WheelCounter {
 public:
  enum class Step : std::uint8_t {
    moved,         ///< the count followed the wheel
    rebased,       ///< the position is the new base; the count stayed
    jumped,        ///< as rebased, because the step was not believable
    out_of_range,  ///< the position is not inside of the modulus; ignored
  };

  WheelCounter() = default;
  explicit WheelCounter(const WheelCounterConfig& config) : config_(config) {}

  /// `position`: as decoded, signed or not; anything in [-modulus, modulus) is taken modulo the
  /// modulus.
  Step update(Timestamp stamp, std::int64_t position);
  /// The next position is a new base: the device restarted.
  void expect_restart() { has_base_ = false; }
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }

 private:
  [[nodiscard]] bool believable(std::int64_t step, Duration silence) const;
  [[nodiscard]] bool ambiguous(Duration silence) const;

  WheelCounterConfig config_{};
  std::int64_t ticks_ = 0;
  Timestamp last_stamp_{};
  std::uint32_t last_position_ = 0;
  bool has_base_ = false;
};

}  // namespace picolo::inline v0

namespace picolo::inline v0::canopen {
using v0::WheelCounter;
using v0::WheelCounterConfig;
}  // namespace picolo::inline v0::canopen
