// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A watchdog that tells instead of resetting.
#pragma once

#include <cstdint>

#include "picolo/hal/clock.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo::inline v0::sim {

/// Runs from construction. Once expired it stays expired, as a board that was reset would show.
class SimWatchdog final : public Watchdog {
 public:
  SimWatchdog(Clock& clock, Duration period)
      : clock_(clock), period_(period), last_stroke_(clock.now()) {}
  void stroke() override {
    expired_ = expired();
    last_stroke_ = clock_.now();
    ++strokes_;
  }
  [[nodiscard]] bool expired() const { return expired_ || clock_.now() - last_stroke_ > period_; }
  [[nodiscard]] std::uint32_t strokes() const { return strokes_; }
  [[nodiscard]] Duration period() const { return period_; }

 private:
  Clock& clock_;
  Duration period_;
  Timestamp last_stroke_;
  std::uint32_t strokes_ = 0;
  bool expired_ = false;
};

}  // namespace picolo::inline v0::sim
