// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every Watchdog must do.
#pragma once

#include <concepts>

#include "picolo/hal/clock.hpp"
#include "picolo/hal/conformance/checker.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo::inline v0::conformance {

/// `period`: what the port states. `fired`: whether the watchdog has acted, observed without being
/// reset (a marker in RAM, an early-warning interrupt); a port that cannot observe it checks on the
/// bench. Optional: `start_watchdog()`, for one that would fire during the checks of other devices.
template <typename H>
concept WatchdogHarness = requires(H& harness, Duration duration) {
  { harness.watchdog() } -> std::convertible_to<Watchdog&>;
  { harness.period() } -> std::same_as<Duration>;
  { harness.fired() } -> std::convertible_to<bool>;
  harness.wait(duration);
};

template <WatchdogHarness Harness>
void check_watchdog(Harness& harness, Checker& checker) {
  if constexpr (requires { harness.start_watchdog(); }) { harness.start_watchdog(); }
  const Duration period = harness.period();
  if (!checker.expect(period > Duration{0}, "the port states the watchdog's period",
                      "return the configured time-out")) {
    return;
  }
  harness.watchdog().stroke();
  for (int i = 0; i < 8; ++i) {
    harness.wait(period / 2);
    harness.watchdog().stroke();
  }
  checker.expect(!harness.fired(), "a watchdog that is stroked twice a period does not fire",
                 "reload the counter in stroke");
  harness.wait(2 * period);
  checker.expect(harness.fired(), "a watchdog that is not stroked fires",
                 "start it in the port's initialisation");
}

}  // namespace picolo::inline v0::conformance
