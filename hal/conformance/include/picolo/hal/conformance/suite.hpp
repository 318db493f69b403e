// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The whole suite in one call, told in text: what a board runs, where no test framework does.
/// docs/porting.md shows how.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/hal/conformance/byte_store.hpp"
#include "picolo/hal/conformance/can_bus.hpp"
#include "picolo/hal/conformance/checker.hpp"
#include "picolo/hal/conformance/clock.hpp"
#include "picolo/hal/conformance/serial_port.hpp"
#include "picolo/hal/conformance/watchdog.hpp"

namespace picolo::inline v0::conformance {

/// Takes text to where a person or a test reads it: semihosting, a spare UART, a debugger.
using Write = void (*)(const char* text);

/// One line a device, three a violation.
class Suite {
 public:
  explicit Suite(Write write) : write_(write) {}

  /// `check` is called with a Checker. True when it found nothing.
  template <typename Check>
  bool run(const char* device, Check check) {
    Checker checker{&Suite::violation, this};
    check(checker);
    write_(device);
    write_(": ");
    write_count(checker.checked());
    write_(" contracts checked, ");
    write_count(checker.violated());
    write_(" violated\n");
    checked_ += checker.checked();
    violated_ += checker.violated();
    return checker.violated() == 0;
  }
  [[nodiscard]] std::uint32_t checked() const { return checked_; }
  [[nodiscard]] std::uint32_t violated() const { return violated_; }

 private:
  static void violation(void* context, const char* contract, const char* cure) {
    const Write write = static_cast<Suite*>(context)->write_;
    write("  violated: ");
    write(contract);
    write("\n      cure: ");
    write(cure);
    write("\n");
  }
  void write_count(std::uint32_t count) const {
    char text[11];
    std::size_t at = sizeof text - 1;
    text[at] = '\0';
    do {
      text[--at] = static_cast<char>('0' + count % 10);
      count /= 10;
    } while (count != 0);
    write_(text + at);
  }

  Write write_;
  std::uint32_t checked_ = 0;
  std::uint32_t violated_ = 0;
};

/// Checks every device that `harness` offers, in the order in which a port is best written; what
/// each needs is the concept in its header. Without a clock that runs nothing else is checked.
template <ClockHarness Harness>
void check_port(Harness& harness, Suite& suite) {
  if (!suite.run("Clock", [&](Checker& checker) { check_clock(harness, checker); })) { return; }
  if constexpr (SerialPortHarness<Harness>) {
    suite.run("SerialPort", [&](Checker& checker) { check_serial_port(harness, checker); });
  }
  if constexpr (CanBusHarness<Harness>) {
    suite.run("CanBus", [&](Checker& checker) { check_can_bus(harness, checker); });
  }
  if constexpr (ByteStoreHarness<Harness>) {
    suite.run("ByteStore", [&](Checker& checker) { check_byte_store(harness, checker); });
  }
  if constexpr (CycleCounterHarness<Harness>) {
    suite.run("CycleCounter", [&](Checker& checker) { check_cycle_counter(harness, checker); });
  }
  if constexpr (WatchdogHarness<Harness>) {
    suite.run("Watchdog", [&](Checker& checker) { check_watchdog(harness, checker); });
  }
}

}  // namespace picolo::inline v0::conformance
