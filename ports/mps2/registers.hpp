// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Memory-mapped registers and the interrupt mask of a Cortex-M.
#pragma once

#include <cstdint>

namespace picolo::inline v0::mps2 {

inline volatile std::uint32_t& reg(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

/// No interrupt but the NMI while it lives; nests.
class InterruptLock {
 public:
  InterruptLock() { __asm__ volatile("mrs %0, primask\n cpsid i" : "=r"(was_locked_)::"memory"); }
  ~InterruptLock() { __asm__ volatile("msr primask, %0" ::"r"(was_locked_) : "memory"); }
  InterruptLock(const InterruptLock&) = delete;
  InterruptLock& operator=(const InterruptLock&) = delete;

 private:
  std::uint32_t was_locked_;
};

/// Lets an external interrupt through the NVIC.
inline void enable_interrupt(unsigned number) {
  reg(0xE000E100 + 4 * (number / 32)) = 1U << (number % 32);
}

}  // namespace picolo::inline v0::mps2
