// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The port on the bench: its devices, and what plays the other ends of their wires. Copy it with
/// the port; docs/porting.md says what each of the functions at the end may be made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/template/template_port.hpp"

namespace picolo::inline v0::template_port {

class TemplateBench {
 public:
  [[nodiscard]] Clock& clock() { return clock_; }
  [[nodiscard]] SerialPort& port() { return port_; }
  [[nodiscard]] CanBus& bus() { return bus_; }
  [[nodiscard]] ByteStore& store() { return store_; }
  [[nodiscard]] CycleCounter& cycle_counter() { return counter_; }
  [[nodiscard]] Watchdog& watchdog() { return watchdog_; }
  /// Of the watchdog, as configured.
  [[nodiscard]] Duration period() { return 100ms; }

  [[nodiscard]] Timestamp now() { return clock_.now(); }
  /// Gives up when the clock stands still, so that the suite can say so.
  void wait(Duration duration) {
    const Timestamp end = now() + duration;
    Timestamp last = now();
    for (int standing = 0; last < end && standing < 100'000; ++standing) {
      const Timestamp seen = now();
      if (seen != last) { standing = 0; }
      last = seen;
    }
  }

  // The other ends: a second CAN controller and a second UART of the board, an adapter on the
  // bench, a loop of wire.
  [[nodiscard]] bool inject(std::span<const std::uint8_t> /*bytes*/) { return false; }
  [[nodiscard]] std::size_t sent(std::span<std::uint8_t> /*buffer*/) { return 0; }
  [[nodiscard]] bool inject(const CanFrame& /*frame*/) { return false; }
  [[nodiscard]] Result<CanFrame> sent() { return Status::not_ready; }
  /// The watchdog's early warning, or a marker in memory that survives its reset.
  [[nodiscard]] bool fired() { return false; }

 private:
  TemplateClock clock_;
  TemplateSerialPort port_;
  TemplateCanBus bus_;
  TemplateByteStore store_;
  TemplateCycleCounter counter_;
  TemplateWatchdog watchdog_;
};

}  // namespace picolo::inline v0::template_port
