// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every Clock and CycleCounter must do.
#pragma once

#include <concepts>
#include <cstdint>

#include "picolo/hal/clock.hpp"
#include "picolo/hal/conformance/checker.hpp"

namespace picolo::inline v0::conformance {

/// `wait(d)`: returns after at least `d` of the clock's own time.
template <typename H>
concept ClockHarness = requires(H& harness, Duration duration) {
  { harness.clock() } -> std::convertible_to<Clock&>;
  harness.wait(duration);
};

template <typename H>
concept CycleCounterHarness = ClockHarness<H> && requires(H& harness) {
  { harness.cycle_counter() } -> std::convertible_to<CycleCounter&>;
};

template <ClockHarness Harness>
void check_clock(Harness& harness, Checker& checker) {
  Clock& clock = harness.clock();
  Timestamp last = clock.now();
  bool backwards = false;
  for (int i = 0; i < 1000; ++i) {
    const Timestamp now = clock.now();
    backwards = backwards || now < last;
    last = now;
  }
  checker.expect(
      !backwards, "Clock::now never steps back",
      "read the high word of an extended counter again when the low word has wrapped meanwhile; "
      "on Linux use CLOCK_MONOTONIC");

  const Timestamp before = clock.now();
  harness.wait(20ms);
  const Duration passed = clock.now() - before;
  checker.expect(
      passed >= 20ms,
      "Clock::now counts microseconds: after a wait of 20 ms at least 20 ms have passed",
      "scale the hardware counter to microseconds; check the timer's clock source and prescaler");
  checker.expect(passed < 10s, "Clock::now counts microseconds: a wait of 20 ms does not take 10 s",
                 "scale the hardware counter to microseconds, not to nanoseconds");
}

template <CycleCounterHarness Harness>
void check_cycle_counter(Harness& harness, Checker& checker) {
  CycleCounter& counter = harness.cycle_counter();
  Clock& clock = harness.clock();
  const std::uint32_t per_us = counter.cycles_per_us();
  if (!checker.expect(
          per_us != 0, "CycleCounter::cycles_per_us is never 0",
          "return the core clock in MHz; round a slower counter up to 1 and prescale it")) {
    return;
  }
  const Timestamp outer_begin = clock.now();
  const std::uint32_t begin = counter.cycles();
  const Timestamp inner_begin = clock.now();
  harness.wait(10ms);
  const Timestamp inner_end = clock.now();
  const std::uint32_t end = counter.cycles();
  const Timestamp outer_end = clock.now();

  // The counter may wrap once in between; 10 ms are far less than its period.
  const auto counted = static_cast<std::int64_t>(static_cast<std::uint32_t>(end - begin));
  const std::int64_t least = (inner_end - inner_begin).count() * std::int64_t{per_us};
  const std::int64_t most = ((outer_end - outer_begin).count() + 1) * std::int64_t{per_us};
  checker.expect(counted * 10 >= least * 9,
                 "CycleCounter::cycles runs at cycles_per_us, and while the processor sleeps",
                 "enable the counter (DWT_CTRL on Cortex-M) and keep its clock on in sleep mode");
  checker.expect(counted * 10 <= most * 11,
                 "CycleCounter::cycles runs at cycles_per_us, not faster",
                 "cycles_per_us must be the rate of this counter, not of another clock");
  checker.expect(counter.cycles_per_us() == per_us, "CycleCounter::cycles_per_us does not change",
                 "do not scale the core clock while picolo runs");
}

}  // namespace picolo::inline v0::conformance
