// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Stands for your board: timers, one CAN controller, two serial lines. Nothing is connected to it.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/hal/watchdog.hpp"

namespace board {

using namespace picolo;

class Timer final : public Clock, public CycleCounter {
 public:
  Timestamp now() override { return now_; }
  std::uint32_t cycles() override {
    return static_cast<std::uint32_t>(now_.time_since_epoch().count());
  }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1; }
  /// On a board: wait for the interrupt of a hardware timer. False when power goes off, here after
  /// ten seconds.
  bool sleep_until(Timestamp instant) {
    now_ = instant;
    return now_ < Timestamp{10s};
  }

 private:
  Timestamp now_{};
};

/// On a board: the receive interrupt pushes into an SpscRing, `receive` pops.
class Can final : public CanBus {
 public:
  Result<CanFrame> receive() override { return Status::not_ready; }
  Status transmit(const CanFrame& /*frame*/) override { return Status::ok; }
  [[nodiscard]] CanStatus status() const override { return {}; }
};

/// On a board: a DMA ring, `read` copies what has arrived since the last call.
class Uart final : public SerialPort {
 public:
  explicit Uart(std::uint32_t baud) : baud_(baud) {}
  Result<SerialRead> read(std::span<std::uint8_t> /*buffer*/) override { return Status::not_ready; }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override { return bytes.size(); }
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return 0; }

 private:
  std::uint32_t baud_;
};

class Dog final : public Watchdog {
 public:
  void stroke() override {}
};

}  // namespace board
