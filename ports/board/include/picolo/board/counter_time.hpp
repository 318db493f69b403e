// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// 64-bit microseconds from a hardware counter of 32 bits that wraps.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0::board {

/// Must be told the counter at least once in each of its rounds (2^32 ticks), in the order of time:
/// read the hardware and call this with interrupts locked when both a cycle and interrupts ask for
/// the time. No fraction of a microsecond is lost. Cost: one 32-bit division.
class CounterTime {
 public:
  /// Time 0 is when the counter shows `count`. Precondition: ticks_per_us > 0.
  constexpr CounterTime(std::uint32_t ticks_per_us, std::uint32_t count)
      : ticks_per_us_(ticks_per_us), last_count_(count) {}
  /// The time at which an up-counting counter shows `count`.
  [[nodiscard]] Timestamp at(std::uint32_t count);

 private:
  std::uint32_t ticks_per_us_;
  std::uint32_t last_count_;
  std::uint32_t rest_ticks_ = 0;  // less than one microsecond
  Timestamp last_{};
};

}  // namespace picolo::inline v0::board
