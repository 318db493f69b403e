// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Keeps the clock of an emulated board and the world simulated around it together.
#pragma once

#include <cstdint>

#include "picolo/hal/clock.hpp"

namespace picolo::inline v0::mps2 {

/// Pulses tell the time: a byte a millisecond on the fourth UART, the low 8 bits of the
/// milliseconds since the start; QEMU leaves some out when the core sleeps. The world lives until
/// then, sends what is due, and answers each pulse with one byte: the low 8 bits of how many bytes
/// it has sent to the other UARTs so far. An idle emulated board that sleeps only when it is level
/// has every byte at about its own time, however slow the emulator's lines are. Hardware needs none
/// of this.
class HostPace {
 public:
  explicit HostPace(Clock& clock) : clock_(clock) {}

  void start();
  /// Every pulse was answered, and what was promised has arrived. `arrived`: bytes, on all UARTs of
  /// the world.
  [[nodiscard]] bool level(std::uint32_t arrived) const;

  /// From the interrupts of CMSDK timer 0 and of the fourth UART.
  void on_timer();
  void on_answer();
  static constexpr unsigned kTimerInterrupt = 8;
  static constexpr unsigned kAnswerInterrupt = 18;

 private:
  Clock& clock_;
  Timestamp last_pulse_{};
  std::uint8_t milliseconds_ = 0;
  volatile std::uint32_t pulses_ = 0;
  volatile std::uint32_t answers_ = 0;
  volatile std::uint32_t promised_ = 0;
};

}  // namespace picolo::inline v0::mps2
