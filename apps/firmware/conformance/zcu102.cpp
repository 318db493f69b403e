// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// QEMU: -object can-bus,id=can -M xlnx-zcu102,canbus0=can,canbus1=can, and the two serial lines
// connected with each other.

#include "conformance_image.hpp"
#include "platform.hpp"
#include "zcu102_bench.hpp"

namespace picolo {
namespace {

constinit Zcu102Bench g_bench;
[[gnu::section(".noinit")]] alignas(8) std::uint8_t g_flash[8 * 4096];

}  // namespace

Status Zcu102Bench::start() {
  reopen();
  interrupts.start();
  Status status = interrupts.attach(zcu102::kCycleTimerInterrupt, timer);
  if (is_ok(status)) { status = interrupts.attach(zcu102::kWatchdogInterrupt, dog); }
  if (is_ok(status)) { status = interrupts.attach(zcu102::kCan0Interrupt, can0); }
  if (is_ok(status)) { status = interrupts.attach(zcu102::kCan1Interrupt, can1); }
  if (is_ok(status)) { status = interrupts.attach(zcu102::kUart0Interrupt, uart0); }
  if (is_ok(status)) { status = can0.open(); }
  if (is_ok(status)) { status = can1.open(); }
  if (is_ok(status)) { status = uart0.open(); }
  if (is_ok(status)) { status = uart1.open(); }
  return status;
}

void Zcu102Bench::reopen() {
  flash.emplace(g_flash, 4096);
}

void Zcu102Bench::wait(Duration duration) {
  const Timestamp end = now() + duration;
  while (now() < end) {
    uart1.on_interrupt();
    timer.sleep_until(now() + 1ms < end ? now() + 1ms : end);
  }
}

bool Zcu102Bench::inject(std::span<const std::uint8_t> bytes) {
  const Result<std::size_t> taken = uart1.write(bytes);
  return taken && *taken == bytes.size();
}

std::size_t Zcu102Bench::sent(std::span<std::uint8_t> buffer) {
  // The bytes come through a socket of QEMU's: give it a moment.
  for (int i = 0; i < 20; ++i) {
    uart1.on_interrupt();
    if (const Result<SerialRead> read = uart1.read(buffer)) { return read->size; }
    timer.sleep_until(now() + 1ms);
  }
  return 0;
}

void check_board(conformance::Suite& suite) {
  Zcu102Bench& bench = g_bench;
  suite.run("devices of the zcu102", [&](conformance::Checker& checker) {
    checker.expect(is_ok(bench.start()), "the devices can be opened", "see XilinxCanBus::open");
  });
  suite.run("CAN registers", [&](auto& checker) { check_can_registers(bench, checker); });
  suite.run("UART registers", [&](auto& checker) { check_uart_registers(bench, checker); });
  suite.run("cycle timer", [&](auto& checker) { check_cycle_timer(bench, checker); });
  conformance::check_port(bench, suite);
  suite.run("interrupts", [&](conformance::Checker& checker) {
    checker.expect(bench.interrupts.unexpected() == 0, "every interrupt has a handler",
                   "attach the device before it is opened");
  });
}

}  // namespace picolo

extern "C" void interrupt_handler() {
  picolo::g_bench.interrupts.serve();
}

extern "C" [[noreturn]] void fault_handler() {
  picolo::platform::write("the processor faulted\n");
  picolo::platform::leave(3);
}
