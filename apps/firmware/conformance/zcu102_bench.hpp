// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The devices of the zcu102 and the other ends of their wires: CAN1 on the bus of CAN0, UART1
/// crossed with UART0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "picolo/board/memory_byte_store.hpp"
#include "picolo/hal/conformance/suite.hpp"
#include "picolo/zcu102/cadence_serial_port.hpp"
#include "picolo/zcu102/generic_timer.hpp"
#include "picolo/zcu102/interrupts.hpp"
#include "picolo/zcu102/xilinx_can_bus.hpp"

namespace picolo {

struct Zcu102Bench {
  zcu102::Interrupts interrupts;
  zcu102::GenericClock generic_clock;
  zcu102::GenericCycleCounter counter;
  zcu102::CycleTimer timer;
  zcu102::TimerWatchdog dog;
  zcu102::XilinxCanBus can0{generic_clock, {.base = zcu102::kCan0}};
  zcu102::XilinxCanBus can1{generic_clock, {.base = zcu102::kCan1}};
  zcu102::CadenceSerialPort uart0{generic_clock, {.base = zcu102::kUart0}};
  /// Without interrupt: served while the bench waits, so that it holds bytes back like a device
  /// that does not listen.
  zcu102::CadenceSerialPort uart1{generic_clock, {.base = zcu102::kUart1}};

  /// Memory that start-up code leaves alone stands in for the board's flash.
  std::optional<board::MemoryByteStore> flash;

  [[nodiscard]] Status start();
  void reopen();

  Clock& clock() { return generic_clock; }
  CycleCounter& cycle_counter() { return counter; }
  CanBus& bus() { return can0; }
  SerialPort& port() { return uart0; }
  ByteStore& store() { return *flash; }
  Watchdog& watchdog() { return dog; }
  void start_watchdog() { dog.start(400ms); }
  Duration period() { return dog.period(); }
  bool fired() { return dog.fired(); }
  Timestamp now() { return generic_clock.now(); }
  void wait(Duration duration);
  bool inject(const CanFrame& frame) { return is_ok(can1.transmit(frame)); }
  Result<CanFrame> sent() { return can1.receive(); }
  bool inject(std::span<const std::uint8_t> bytes);
  std::size_t sent(std::span<std::uint8_t> buffer);
  // The emulated bus takes no time: only a controller that may not send keeps its frames.
  void hold() { can0.set_mode(zcu102::CanMode::listen_only); }
  void release() { can0.set_mode(zcu102::CanMode::normal); }
  void unplug_bus() { can0.set_mode(zcu102::CanMode::off); }
  void plug_bus() { can0.set_mode(zcu102::CanMode::normal); }
};

/// What the suite does not know: filters, overflows and modes of the controllers.
void check_can_registers(Zcu102Bench& bench, conformance::Checker& checker);
void check_uart_registers(Zcu102Bench& bench, conformance::Checker& checker);
void check_cycle_timer(Zcu102Bench& bench, conformance::Checker& checker);

}  // namespace picolo
