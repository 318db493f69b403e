// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The Cadence UART of the Zynq family.
#pragma once

#include <cstdint>

#include "picolo/board/serial_rings.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/zcu102/board.hpp"

namespace picolo::inline v0::zcu102 {

struct CadenceSerialConfig {
  std::uintptr_t base = kUart0;
  std::uint32_t clock_hz = 100'000'000;  ///< UART reference clock
  std::uint32_t baud = 115'200;
  bool loop_back = false;  ///< what is written comes back inside of the device: a test without wire
};

/// Interrupt-driven in both directions: attach it to its interrupt, then open it. Each byte is
/// stamped in the interrupt that takes it, one byte an interrupt at the rates of sensors.
class CadenceSerialPort final : public SerialPort {
 public:
  constexpr CadenceSerialPort(Clock& clock, const CadenceSerialConfig& config)
      : clock_(clock), config_(config) {}
  CadenceSerialPort(const CadenceSerialPort&) = delete;
  CadenceSerialPort& operator=(const CadenceSerialPort&) = delete;
  ~CadenceSerialPort() = default;

  /// `invalid_argument`: no divider gives the rate within 2 %.
  Status open();
  void on_interrupt();

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    return rings_.read(buffer, clock_);
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return config_.baud; }
  /// An overrun of the hardware's FIFO counts once, however many bytes it cost.
  [[nodiscard]] std::uint32_t lost() const override { return rings_.lost(); }

 private:
  void fill_fifo();

  Clock& clock_;
  CadenceSerialConfig config_;
  board::SerialRings rings_{};
};

}  // namespace picolo::inline v0::zcu102
