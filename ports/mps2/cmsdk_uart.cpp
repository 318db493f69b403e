// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Registers: Arm Cortex-M System Design Kit TRM (DDI 0479), APB UART.

#include "picolo/mps2/cmsdk_uart.hpp"

#include "registers.hpp"

namespace picolo::inline v0::mps2 {
namespace {

constexpr std::uintptr_t kData = 0x00;
constexpr std::uintptr_t kState = 0x04;
constexpr std::uintptr_t kControl = 0x08;
constexpr std::uintptr_t kClear = 0x0C;
constexpr std::uintptr_t kDivider = 0x10;

constexpr std::uint32_t kReceived = 1U << 1;        // in kState
constexpr std::uint32_t kReceiveOverrun = 1U << 3;  // in kState and kClear
constexpr std::uint32_t kSentInterrupt = 1U << 0;   // in kClear
constexpr std::uint32_t kReceiveInterrupt = 1U << 1;
// Both directions, interrupts of both, and of overruns while receiving.
constexpr std::uint32_t kOn = 0b10'1111;
constexpr std::uint32_t kClockHz = 25'000'000;

}  // namespace

CmsdkUart::CmsdkUart(const UartPlace& place, Clock& clock, std::uint32_t baud)
    : place_(place), clock_(clock), baud_(baud) {}

void CmsdkUart::start() {
  reg(place_.base + kDivider) = (kClockHz + baud_ / 2) / baud_;
  reg(place_.base + kControl) = kOn;
  enable_interrupt(place_.receive_interrupt);
  enable_interrupt(place_.receive_interrupt + 1);
}

void CmsdkUart::on_receive() {
  reg(place_.base + kClear) = kReceiveInterrupt;
  while ((reg(place_.base + kState) & kReceived) != 0) {
    const auto byte = static_cast<std::uint8_t>(reg(place_.base + kData) & 0xFFU);
    rings_.received(byte, clock_.now());
  }
}

void CmsdkUart::on_overrun() {
  if ((reg(place_.base + kState) & kReceiveOverrun) == 0) { return; }
  reg(place_.base + kState) = kReceiveOverrun;
  rings_.overrun();
}

Result<std::size_t> CmsdkUart::write(std::span<const std::uint8_t> bytes) {
  const Result<std::size_t> taken = rings_.write(bytes);
  const InterruptLock lock;
  if (!sending_) { send_next(); }
  return taken;
}

void CmsdkUart::on_sent() {
  reg(place_.base + kClear) = kSentInterrupt;
  send_next();
}

/// Its interrupt comes when the byte has left. Interrupts are locked, or this is one.
void CmsdkUart::send_next() {
  std::uint8_t byte = 0;
  sending_ = rings_.next_to_send(byte);
  if (sending_) { reg(place_.base + kData) = byte; }
}

}  // namespace picolo::inline v0::mps2
