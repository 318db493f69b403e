// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Registers: Arm Cortex-M System Design Kit TRM (DDI 0479), APB watchdog.

#include "picolo/mps2/cmsdk_watchdog.hpp"

#include "picolo/mps2/board_clock.hpp"
#include "registers.hpp"

namespace picolo::inline v0::mps2 {
namespace {

constexpr std::uintptr_t kBase = 0x40008000;
constexpr std::uintptr_t kLoad = kBase;
constexpr std::uintptr_t kControl = kBase + 0x8;
constexpr std::uintptr_t kClear = kBase + 0xC;
constexpr std::uintptr_t kLock = kBase + 0xC00;
constexpr std::uint32_t kKey = 0x1ACCE551;

/// Only between these two may registers be written: stray code shall not stop the watchdog.
class Unlocked {
 public:
  Unlocked() { reg(kLock) = kKey; }
  ~Unlocked() { reg(kLock) = 1; }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
};

}  // namespace

void CmsdkWatchdog::start(Duration period) {
  const Unlocked unlocked;
  reg(kLoad) = static_cast<std::uint32_t>(period.count()) * kTicksPerUs;
  reg(kControl) = 3;  // interrupt, then reset
}

void CmsdkWatchdog::stroke() {
  const Unlocked unlocked;
  reg(kClear) = 1;  // loads it anew, too
}

}  // namespace picolo::inline v0::mps2
