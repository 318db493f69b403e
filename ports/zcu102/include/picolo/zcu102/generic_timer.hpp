// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The generic timer of the processor: clock, cycle, watchdog.
#pragma once

#include <cstdint>

#include "picolo/hal/clock.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo::inline v0::zcu102 {

/// The system counter is 64 bits wide: nothing to extend.
class GenericClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() override;
};

/// Nanoseconds of the system counter, which runs while the processor sleeps.
class GenericCycleCounter final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t cycles() override;
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1000; }
};

/// Lets the processor sleep until an instant: the release of a minor frame, absolute, so that
/// nothing drifts. Attach it to kCycleTimerInterrupt.
class CycleTimer {
 public:
  /// Returns at once when the instant has passed. Interrupts are served meanwhile. Context: main.
  void sleep_until(Timestamp instant);
  void on_interrupt();
  /// How often the timer has woken the processor; never reset.
  [[nodiscard]] std::uint32_t wake_ups() const { return wake_ups_; }

 private:
  volatile std::uint32_t wake_ups_ = 0;
};

/// A second compare register that must be pushed on. Attach it to kWatchdogInterrupt. It tells and
/// does not reset: the system watchdogs of the board are the platform management unit's.
class TimerWatchdog final : public Watchdog {
 public:
  void start(Duration period);
  void stroke() override;
  void on_interrupt();
  [[nodiscard]] Duration period() const { return period_; }
  /// Once fired it stays so.
  [[nodiscard]] bool fired() const { return fired_; }

 private:
  Duration period_{};
  volatile bool fired_ = false;
};

}  // namespace picolo::inline v0::zcu102
