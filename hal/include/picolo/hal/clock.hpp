// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two clocks of a board.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

/// Monotonic time. Only ports and the executive read it. Never steps back, extends hardware
/// counters to 64 bits itself. Context: any. Cost: a few instructions.
class Clock {
 public:
  [[nodiscard]] virtual Timestamp now() = 0;

 protected:
  Clock() = default;
  Clock(const Clock&) = default;
  Clock& operator=(const Clock&) = default;
  ~Clock() = default;
};

/// A free-running counter for measuring work: processor cycles, or instructions, or nanoseconds;
/// wraps at 2^32.
class CycleCounter {
 public:
  [[nodiscard]] virtual std::uint32_t cycles() = 0;
  /// Ticks of `cycles` per microsecond; never 0.
  [[nodiscard]] virtual std::uint32_t cycles_per_us() const = 0;

 protected:
  CycleCounter() = default;
  CycleCounter(const CycleCounter&) = default;
  CycleCounter& operator=(const CycleCounter&) = default;
  ~CycleCounter() = default;
};

}  // namespace picolo::inline v0
