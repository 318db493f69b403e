// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/mps2/host_pace.hpp"

#include "picolo/mps2/board_clock.hpp"
#include "picolo/mps2/cmsdk_uart.hpp"
#include "registers.hpp"

namespace picolo::inline v0::mps2 {
namespace {

constexpr std::uintptr_t kTimer = 0x40000000;
constexpr std::uintptr_t kUart = kUarts[3].base;
static_assert(kUarts[3].receive_interrupt == HostPace::kAnswerInterrupt);

}  // namespace

void HostPace::start() {
  last_pulse_ = clock_.now();
  reg(kUart + 0x10) = 25;      // 1 Mbaud
  reg(kUart + 0x08) = 0b1011;  // both directions, interrupt of receiving
  reg(kTimer + 0x8) = 1000 * kTicksPerUs - 1;
  reg(kTimer + 0x4) = 1000 * kTicksPerUs - 1;
  reg(kTimer) = 0b1001;  // on, with interrupt
  enable_interrupt(kAnswerInterrupt);
  enable_interrupt(kTimerInterrupt);
}

bool HostPace::level(std::uint32_t arrived) const {
  // Modulo 2^32: how far the one is behind the other.
  const auto missing = static_cast<std::int32_t>(promised_ - arrived);
  return answers_ == pulses_ && missing <= 0;
}

void HostPace::on_timer() {
  reg(kTimer + 0xC) = 1;
  const Timestamp now = clock_.now();
  for (; now - last_pulse_ >= 1ms; last_pulse_ += 1ms) { ++milliseconds_; }
  pulses_ = pulses_ + 1;
  reg(kUart) = milliseconds_;
}

void HostPace::on_answer() {
  reg(kUart + 0x0C) = 0b10;
  const std::uint32_t low = reg(kUart) & 0xFFU;
  promised_ = promised_ + ((low - promised_) & 0xFFU);
  answers_ = answers_ + 1;
}

}  // namespace picolo::inline v0::mps2
