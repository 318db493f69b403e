// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Tells the board's time to the outside.
#pragma once

#include <cstdint>

namespace picolo::inline v0::mps2 {

/// One byte a millisecond on the fourth UART: the low 8 bits of the milliseconds since the start.
/// What simulates a vehicle around the board follows it; a bench would use a pulse a second on a
/// pin.
class PulseOutput {
 public:
  void start();
  /// From the interrupt of CMSDK timer 0.
  void on_timer();
  static constexpr unsigned kInterrupt = 8;

 private:
  std::uint8_t milliseconds_ = 0;
};

}  // namespace picolo::inline v0::mps2
