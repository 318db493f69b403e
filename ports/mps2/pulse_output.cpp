// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/mps2/pulse_output.hpp"

#include "picolo/mps2/board_clock.hpp"
#include "picolo/mps2/cmsdk_uart.hpp"
#include "registers.hpp"

namespace picolo::inline v0::mps2 {
namespace {

constexpr std::uintptr_t kTimer = 0x40000000;
constexpr std::uintptr_t kUart = kUarts[3].base;

}  // namespace

void PulseOutput::start() {
  reg(kUart + 0x10) = 25;  // 1 Mbaud
  reg(kUart + 0x08) = 1;   // sends, without interrupts
  reg(kTimer + 0x8) = 1000 * kTicksPerUs - 1;
  reg(kTimer + 0x4) = 1000 * kTicksPerUs - 1;
  reg(kTimer) = 0b1001;  // on, with interrupt
  enable_interrupt(kInterrupt);
}

void PulseOutput::on_timer() {
  reg(kTimer + 0xC) = 1;
  ++milliseconds_;
  const bool full = (reg(kUart + 0x04) & 1U) != 0;  // nobody listens: this one is lost
  if (!full) { reg(kUart) = milliseconds_; }
}

}  // namespace picolo::inline v0::mps2
