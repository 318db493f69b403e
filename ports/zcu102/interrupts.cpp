// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/zcu102/interrupts.hpp"

#include "registers.hpp"

namespace picolo::inline v0::zcu102 {
namespace {

// Arm GICv2 architecture specification, chapter 4.
constexpr std::uintptr_t kDistributor = 0xF901'0000;
constexpr std::uintptr_t kControl = 0x000;
constexpr std::uintptr_t kSetEnable = 0x100;    // one bit an interrupt
constexpr std::uintptr_t kClearEnable = 0x180;  // one bit
constexpr std::uintptr_t kPriority = 0x400;     // one byte
constexpr std::uintptr_t kTargets = 0x800;      // one byte, a bit a processor
constexpr std::uintptr_t kProcessor = 0xF902'0000;
constexpr std::uintptr_t kProcessorControl = 0x00;
constexpr std::uintptr_t kPriorityMask = 0x04;
constexpr std::uintptr_t kAcknowledge = 0x0C;
constexpr std::uintptr_t kEndOfInterrupt = 0x10;
constexpr std::uint32_t kFirstShared = 32;
constexpr std::uint32_t kFirstSpecial = 1020;  // 1023: none is pending

void set_byte(std::uintptr_t table, std::uint32_t id, std::uint32_t value) {
  volatile std::uint32_t& word = reg(kDistributor, table + (id & ~3U));
  const std::uint32_t shift = 8 * (id & 3U);
  word = (word & ~(0xFFU << shift)) | (value << shift);
}

}  // namespace

void Interrupts::start() {
  reg(kDistributor, kControl) = 1;
  reg(kProcessor, kPriorityMask) = 0xFF;
  reg(kProcessor, kProcessorControl) = 1;
  __asm__ volatile("dsb sy\n isb\n msr daifclr, #2" ::: "memory");
}

Status Interrupts::attach(std::uint32_t id, Handler handler, void* context) {
  if (!entries_.push_back({id, handler, context})) { return Status::full; }
  set_byte(kPriority, id, 0x80);
  if (id >= kFirstShared) { set_byte(kTargets, id, 1); }
  enable(id);
  return Status::ok;
}

void Interrupts::enable(std::uint32_t id) {
  reg(kDistributor, kSetEnable + id / 32 * 4) = 1U << (id % 32);
}

void Interrupts::disable(std::uint32_t id) {
  reg(kDistributor, kClearEnable + id / 32 * 4) = 1U << (id % 32);
  __asm__ volatile("dsb sy" ::: "memory");
}

void Interrupts::serve() {
  for (std::size_t served = 0; served < kHandlers; ++served) {
    const std::uint32_t acknowledged = reg(kProcessor, kAcknowledge);
    const std::uint32_t id = acknowledged & 0x3FFU;
    if (id >= kFirstSpecial) { return; }
    dispatch(id);
    // The device must have seen that it was served before the controller looks at its line again.
    __asm__ volatile("dsb sy" ::: "memory");
    reg(kProcessor, kEndOfInterrupt) = acknowledged;
  }
}

void Interrupts::dispatch(std::uint32_t id) {
  for (const Entry& entry : entries_.view()) {
    if (entry.id == id) {
      entry.handler(entry.context);
      return;
    }
  }
  disable(id);
  unexpected_ = unexpected_ + 1;
}

}  // namespace picolo::inline v0::zcu102
