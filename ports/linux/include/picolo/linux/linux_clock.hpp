// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Time on Linux: CLOCK_MONOTONIC, and the absolute sleep that paces the cycle.
#pragma once

#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/hal/clock.hpp"

namespace picolo::inline v0 {

/// CLOCK_MONOTONIC in microseconds. Never steps, whatever the wall clock does.
class LinuxClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() override;
};

/// Nanoseconds of CLOCK_MONOTONIC, modulo 2^32: the time that passed, not the cycles that were
/// spent.
class LinuxCycleCounter final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t cycles() override;
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1000; }
};

/// Sleeps until an instant of LinuxClock; returns at once when it has passed. Absolute, so that
/// lateness never adds up. `not_ready`: a signal came first. Context: the thread that runs the
/// cycle.
Status sleep_until(Timestamp wake);

}  // namespace picolo::inline v0
