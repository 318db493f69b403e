// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/zcu102/cadence_serial_port.hpp"

#include "registers.hpp"

namespace picolo::inline v0::zcu102 {
namespace {

// UG1085, chapter 21, and UG1087, module UART.
constexpr std::uintptr_t kControl = 0x00;
constexpr std::uintptr_t kMode = 0x04;
constexpr std::uintptr_t kInterruptEnable = 0x08;
constexpr std::uintptr_t kInterruptDisable = 0x0C;
constexpr std::uintptr_t kInterruptMask = 0x10;
constexpr std::uintptr_t kInterruptStatus = 0x14;
constexpr std::uintptr_t kBaudGenerator = 0x18;
constexpr std::uintptr_t kReceiveTrigger = 0x20;
constexpr std::uintptr_t kChannelStatus = 0x2C;
constexpr std::uintptr_t kFifo = 0x30;
constexpr std::uintptr_t kBaudDivider = 0x34;

constexpr std::uint32_t kReset = 0x03;
constexpr std::uint32_t kEnable = 0x14;
constexpr std::uint32_t kDisable = 0x28;
constexpr std::uint32_t kEightBitsNoParity = 0x20;
constexpr std::uint32_t kLocalLoopBack = 0x200;
// Of interrupt status, mask and channel status alike.
constexpr std::uint32_t kReceiveTriggered = 0x01;
constexpr std::uint32_t kReceiveEmpty = 0x02;
constexpr std::uint32_t kTransmitEmpty = 0x08;
constexpr std::uint32_t kTransmitFull = 0x10;
constexpr std::uint32_t kReceiveOverrun = 0x20;

constexpr std::size_t kFifoBytes = 64;
// The emulated FIFO is that deep, and in loop-back what is sent lies in it at once.
constexpr std::size_t kBurst = 16;

struct Dividers {
  std::uint32_t generator = 0;  ///< 1 to 65535
  std::uint32_t divider = 0;    ///< 4 to 255; one bit is generator * (divider + 1) clocks
};

std::uint32_t distance(std::uint32_t a, std::uint32_t b) {
  return a > b ? a - b : b - a;
}

Dividers dividers_for(std::uint32_t clock_hz, std::uint32_t baud) {
  Dividers best;
  std::uint32_t best_error = baud / 50;  // 2 %
  for (std::uint32_t divider = 4; divider < 256 && baud > 0; ++divider) {
    const std::uint32_t per_count = clock_hz / (divider + 1);
    const std::uint32_t generator = (per_count + baud / 2) / baud;
    if (generator < 1 || generator > 65'535) { continue; }
    const std::uint32_t error = distance(per_count / generator, baud);
    if (error < best_error || (error == best_error && best.generator == 0)) {
      best = {generator, divider};
      best_error = error;
    }
  }
  return best;
}

}  // namespace

Status CadenceSerialPort::open() {
  const Dividers dividers = dividers_for(config_.clock_hz, config_.baud);
  if (dividers.generator == 0) { return Status::invalid_argument; }
  const std::uintptr_t base = config_.base;
  reg(base, kControl) = kDisable;
  reg(base, kInterruptDisable) = 0xFFFF'FFFF;
  reg(base, kBaudGenerator) = dividers.generator;
  reg(base, kBaudDivider) = dividers.divider;
  reg(base, kMode) = kEightBitsNoParity | (config_.loop_back ? kLocalLoopBack : 0U);
  reg(base, kReceiveTrigger) = 1;
  reg(base, kControl) = kDisable | kReset;
  reg(base, kControl) = kEnable;
  reg(base, kInterruptStatus) = 0xFFFF'FFFF;
  reg(base, kInterruptEnable) = kReceiveTriggered | kReceiveOverrun;
  return Status::ok;
}

void CadenceSerialPort::on_interrupt() {
  const std::uintptr_t base = config_.base;
  const std::uint32_t pending = reg(base, kInterruptStatus) & reg(base, kInterruptMask);
  // First, so that a byte that comes while the FIFO is emptied interrupts again.
  reg(base, kInterruptStatus) = pending;
  if ((pending & kReceiveOverrun) != 0) { rings_.overrun(); }
  const Timestamp now = clock_.now();
  for (std::size_t i = 0; i < kFifoBytes && (reg(base, kChannelStatus) & kReceiveEmpty) == 0; ++i) {
    rings_.received(static_cast<std::uint8_t>(reg(base, kFifo)), now);
  }
  if ((pending & kTransmitEmpty) != 0) { fill_fifo(); }
}

void CadenceSerialPort::fill_fifo() {
  const std::uintptr_t base = config_.base;
  std::uint8_t byte = 0;
  for (std::size_t i = 0; i < kBurst; ++i) {
    if ((reg(base, kChannelStatus) & kTransmitFull) != 0) { return; }
    if (!rings_.next_to_send(byte)) {
      reg(base, kInterruptDisable) = kTransmitEmpty;
      return;
    }
    reg(base, kFifo) = byte;
  }
}

Result<std::size_t> CadenceSerialPort::write(std::span<const std::uint8_t> bytes) {
  const Result<std::size_t> taken = rings_.write(bytes);
  if (taken) { reg(config_.base, kInterruptEnable) = kTransmitEmpty; }
  return taken;
}

}  // namespace picolo::inline v0::zcu102
