// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The generic interrupt controller (GIC-400): who is called for which interrupt.
#pragma once

#include <cstdint>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0::zcu102 {

/// One for the processor. The application defines `extern "C" void interrupt_handler()` and calls
/// `serve` from it. Interrupts do not nest. Static storage: start-up code clears it.
class Interrupts {
 public:
  using Handler = void (*)(void* context);
  static constexpr std::size_t kHandlers = 8;

  /// Opens the controller and the processor for interrupts. Context: main, once.
  void start();
  /// `full`: more than kHandlers. Context: main, before the device is opened.
  Status attach(std::uint32_t id, Handler handler, void* context);
  /// Calls `device.on_interrupt()`; the device outlives this object.
  template <typename Device>
  Status attach(std::uint32_t id, Device& device) {
    return attach(
        id, [](void* context) { static_cast<Device*>(context)->on_interrupt(); }, &device);
  }
  /// Stops and lets pass one interrupt; what came meanwhile waits. Context: main.
  void disable(std::uint32_t id);
  void enable(std::uint32_t id);
  /// Serves what is pending. Cost: at most kHandlers handlers; the rest interrupts again.
  void serve();
  /// Interrupts nobody was attached to; they are disabled. Never reset.
  [[nodiscard]] std::uint32_t unexpected() const { return unexpected_; }

 private:
  struct Entry {
    std::uint32_t id = 0;
    Handler handler = nullptr;
    void* context = nullptr;
  };
  void dispatch(std::uint32_t id);

  FixedVector<Entry, kHandlers> entries_{};
  volatile std::uint32_t unexpected_ = 0;
};

}  // namespace picolo::inline v0::zcu102
