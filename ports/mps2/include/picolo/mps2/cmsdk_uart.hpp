// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A UART of the Cortex-M System Design Kit, driven by its interrupts.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/board/serial_rings.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0::mps2 {

/// Where a UART is and which interrupts it has.
struct UartPlace {
  std::uintptr_t base;
  unsigned receive_interrupt;  ///< the next number is that of sending
};
/// The five of the images AN386 and AN500.
inline constexpr UartPlace kUarts[] = {
    {0x40004000, 0}, {0x40005000, 2}, {0x40006000, 4}, {0x40007000, 18}, {0x40009000, 20}};
/// Overruns of the first three share one.
inline constexpr unsigned kUartOverrunInterrupt = 12;

/// The hardware holds one byte: an interrupt that comes later than one byte's time loses it, which
/// is counted.
class CmsdkUart final : public SerialPort {
 public:
  /// Precondition: 1500 <= baud <= 1562500 (25 MHz / 16).
  CmsdkUart(const UartPlace& place, Clock& clock, std::uint32_t baud);
  CmsdkUart(const CmsdkUart&) = delete;
  CmsdkUart& operator=(const CmsdkUart&) = delete;
  ~CmsdkUart() = default;

  /// From then on bytes arrive.
  void start();

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    return rings_.read(buffer, clock_);
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return rings_.lost(); }
  /// Bytes, lost ones included, modulo 2^32.
  [[nodiscard]] std::uint32_t arrived() const { return rings_.arrived(); }

  /// From the interrupts of this UART, and from the shared one.
  void on_receive();
  void on_sent();
  void on_overrun();
  [[nodiscard]] const UartPlace& place() const { return place_; }

 private:
  void send_next();

  UartPlace place_;
  Clock& clock_;
  std::uint32_t baud_;
  volatile bool sending_ = false;
  board::SerialRings rings_{};
};

}  // namespace picolo::inline v0::mps2
