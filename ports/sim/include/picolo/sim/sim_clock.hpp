// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Virtual time: ten minutes of driving pass in seconds, the same ones each time.
#pragma once

#include <cstdint>

#include "picolo/hal/clock.hpp"

namespace picolo::inline v0::sim {

/// Stands still until told otherwise. Never steps back: an earlier instant is ignored.
class SimClock final : public Clock {
 public:
  explicit SimClock(Timestamp start = Timestamp{}) : now_(start) {}
  [[nodiscard]] Timestamp now() override { return now_; }
  void set(Timestamp now) { now_ = now > now_ ? now : now_; }
  /// Lets time pass, e.g. to play a task that takes long.
  void advance(Duration duration) { set(now_ + duration); }

 private:
  Timestamp now_;
};

/// Nanoseconds of virtual time plus whatever `spend` added; so work costs nothing unless a test
/// says so.
class SimCycleCounter final : public CycleCounter {
 public:
  explicit SimCycleCounter(Clock& clock) : clock_(clock) {}
  [[nodiscard]] std::uint32_t cycles() override {
    const auto elapsed_us = static_cast<std::uint64_t>(clock_.now().time_since_epoch().count());
    return static_cast<std::uint32_t>(elapsed_us * kCyclesPerUs) + spent_;
  }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return kCyclesPerUs; }
  void spend(std::uint32_t cycles) { spent_ += cycles; }

 private:
  static constexpr std::uint32_t kCyclesPerUs = 1000;
  Clock& clock_;
  std::uint32_t spent_ = 0;
};

}  // namespace picolo::inline v0::sim
