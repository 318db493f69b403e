// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Another node of the bus: a raw CAN socket that sends whatever it is told to.
#pragma once

#include <linux/can.h>

#include <cstdint>
#include <string>

#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::test {

class CanNode {
 public:
  /// Fails the test when the interface is not there.
  explicit CanNode(const std::string& interface);

  bool send(const CanFrame& frame) const;
  bool send(const can_frame& frame) const;
  bool send(const canfd_frame& frame) const;
  /// An error frame as the kernel makes it. Only sockets on the same interface see it.
  bool send_error(std::uint32_t kind, std::uint8_t controller = 0) const;
  /// Waits for as long as `patience` of the machine's time; `not_ready`: nothing came.
  [[nodiscard]] Result<CanFrame> receive(Duration patience = 1s) const;

 private:
  FileDescriptor socket_;
};

/// Waits until something can be read from `bus`, and reads it. Delivery may be deferred: never look
/// only once. `disconnected` is returned at once.
Result<CanFrame> next(CanBus& bus);

/// Gives what was sent time to arrive, for tests of what must not arrive.
void settle();

}  // namespace picolo::test
