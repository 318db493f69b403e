// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Time and cycles of an MPS2 board, both from CMSDK timer 1 at 25 MHz.
#pragma once

#include <cstdint>

#include "picolo/board/counter_time.hpp"
#include "picolo/hal/clock.hpp"

namespace picolo::inline v0::mps2 {

inline constexpr std::uint32_t kTicksPerUs = 25;

/// The 32-bit counter wraps every 171.8 s; whoever runs a cycle asks more often.
class BoardClock final : public Clock {
 public:
  /// Starts the timer. `first_count`: what it shows at time 0; close to 2^32 for a test of its
  /// wrap.
  explicit BoardClock(std::uint32_t first_count = 0);
  /// Context: the cycle and every interrupt but the NMI; an NMI that never returns may ask, too,
  /// and be told a wrong wrap when it came in the middle of another's asking.
  [[nodiscard]] Timestamp now() override;

 private:
  board::CounterTime time_;
};

/// Ticks of the same timer. The cycle counter of the core (DWT) is finer, but QEMU has none.
class BoardCycles final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t cycles() override;
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return kTicksPerUs; }
};

/// SysTick, once a minor frame.
class FrameTimer {
 public:
  /// Precondition: period at most 671 ms.
  void start(Duration period);
  /// From the SysTick interrupt.
  void tick() { ticks_ = ticks_ + 1; }
  /// True when a tick came since the last call.
  [[nodiscard]] bool take();
  /// Sleeps until any interrupt, unless a tick waits to be taken.
  void rest() const;
  [[nodiscard]] std::uint32_t ticks() const { return ticks_; }

 private:
  volatile std::uint32_t ticks_ = 0;
  std::uint32_t taken_ = 0;
};

}  // namespace picolo::inline v0::mps2
