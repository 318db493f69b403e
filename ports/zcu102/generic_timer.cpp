// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/zcu102/generic_timer.hpp"

namespace picolo::inline v0::zcu102 {
namespace {

// Arm Architecture Reference Manual for A-profile, chapter D11. Bit 0 of a control register starts
// the comparison, bit 1 masks its interrupt.
constexpr std::uint64_t kEnabled = 1;
constexpr std::uint64_t kMasked = 3;

std::uint64_t frequency_hz() {
  std::uint64_t value = 0;
  __asm__("mrs %0, cntfrq_el0" : "=r"(value));
  return value;
}

std::uint64_t counted() {
  std::uint64_t value = 0;
  __asm__ volatile("isb\n mrs %0, cntpct_el0" : "=r"(value)::"memory");
  return value;
}

/// `value` from `rate` to `new_rate`, rounded down, without overflow.
std::uint64_t rescale(std::uint64_t value, std::uint64_t rate, std::uint64_t new_rate) {
  return value / rate * new_rate + value % rate * new_rate / rate;
}

/// The first count that is not before the instant.
std::uint64_t count_at(Timestamp instant) {
  const std::int64_t us = instant.time_since_epoch().count();
  return us <= 0 ? 0 : rescale(static_cast<std::uint64_t>(us), 1'000'000, frequency_hz()) + 1;
}

}  // namespace

Timestamp GenericClock::now() {
  return Timestamp{
      Duration{static_cast<std::int64_t>(rescale(counted(), frequency_hz(), 1'000'000))}};
}

std::uint32_t GenericCycleCounter::cycles() {
  return static_cast<std::uint32_t>(rescale(counted(), frequency_hz(), 1'000'000'000));
}

void CycleTimer::sleep_until(Timestamp instant) {
  const std::uint64_t target = count_at(instant);
  __asm__ volatile("msr cntp_cval_el0, %0\n msr cntp_ctl_el0, %1" ::"r"(target), "r"(kEnabled));
  while (counted() < target) {
    // Masked, a pending interrupt still ends wfi: none can slip in between test and sleep.
    __asm__ volatile("msr daifset, #2" ::: "memory");
    if (counted() < target) { __asm__ volatile("wfi" ::: "memory"); }
    __asm__ volatile("msr daifclr, #2\n isb" ::: "memory");
  }
  __asm__ volatile("msr cntp_ctl_el0, %0" ::"r"(kMasked));
}

void CycleTimer::on_interrupt() {
  __asm__ volatile("msr cntp_ctl_el0, %0\n isb" ::"r"(kMasked));
  wake_ups_ = wake_ups_ + 1;
}

void TimerWatchdog::start(Duration period) {
  period_ = period;
  stroke();
}

void TimerWatchdog::stroke() {
  const std::uint64_t wait =
      rescale(static_cast<std::uint64_t>(period_.count()), 1'000'000, frequency_hz());
  std::uint64_t now = 0;
  __asm__ volatile("isb\n mrs %0, cntvct_el0" : "=r"(now)::"memory");
  __asm__ volatile("msr cntv_cval_el0, %0\n msr cntv_ctl_el0, %1" ::"r"(now + wait), "r"(kEnabled));
}

void TimerWatchdog::on_interrupt() {
  __asm__ volatile("msr cntv_ctl_el0, %0\n isb" ::"r"(kMasked));
  fired_ = true;
}

}  // namespace picolo::inline v0::zcu102
