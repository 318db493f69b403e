// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Registers: Arm Cortex-M System Design Kit TRM (DDI 0479), APB timer; Armv7-M ARM (DDI 0403),
// SysTick.

#include "picolo/mps2/board_clock.hpp"

#include "registers.hpp"

namespace picolo::inline v0::mps2 {
namespace {

constexpr std::uintptr_t kTimer = 0x40001000;
constexpr std::uintptr_t kControl = kTimer;
constexpr std::uintptr_t kValue = kTimer + 0x4;
constexpr std::uintptr_t kReload = kTimer + 0x8;

constexpr std::uintptr_t kSysTickControl = 0xE000E010;
constexpr std::uintptr_t kSysTickReload = 0xE000E014;
constexpr std::uintptr_t kSysTickValue = 0xE000E018;

/// The timer counts down.
std::uint32_t up_count() {
  return 0xFFFFFFFFU - reg(kValue);
}

std::uint32_t start_timer(std::uint32_t first_count) {
  reg(kControl) = 0;
  reg(kReload) = 0xFFFFFFFFU;
  reg(kValue) = 0xFFFFFFFFU - first_count;
  reg(kControl) = 1;
  return first_count;
}

}  // namespace

BoardClock::BoardClock(std::uint32_t first_count) : time_(kTicksPerUs, start_timer(first_count)) {}

Timestamp BoardClock::now() {
  const InterruptLock lock;
  return time_.at(up_count());
}

std::uint32_t BoardCycles::cycles() {
  return up_count();
}

void FrameTimer::start(Duration period) {
  reg(kSysTickControl) = 0;
  reg(kSysTickReload) = static_cast<std::uint32_t>(period.count()) * kTicksPerUs - 1;
  reg(kSysTickValue) = 0;
  reg(kSysTickControl) = 7;  // the processor's clock, interrupt, on
}

bool FrameTimer::take() {
  const std::uint32_t ticks = ticks_;
  const bool came = ticks != taken_;
  taken_ = ticks;
  return came;
}

void FrameTimer::rest() const {
  // Locked, so that no tick slips in between the look and the sleep; WFI wakes all the same.
  const InterruptLock lock;
  if (ticks_ == taken_) { __asm__ volatile("wfi" ::: "memory"); }
}

}  // namespace picolo::inline v0::mps2
