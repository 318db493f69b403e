// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A CAN bus by the name that the command line gives it: an interface, a serial adapter, or a
/// socket for machines whose kernel has no CAN.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "picolo/drivers/slcan/slcan_bus.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/linux/file_descriptor.hpp"
#include "picolo/linux/socket_can_bus.hpp"
#include "picolo/linux/termios_serial_port.hpp"

namespace picolo::tool {

/// can0: that interface. slcan:TTY[,BITRATE[,BAUD]]: a serial adapter. socket:PATH: frames as
/// datagrams to the one other process that names the same path. fd:N: an open socket of that kind.
class CanLine final : public CanBus {
 public:
  enum class Role { first, second };  ///< of a socket: the first makes it, the second looks for it

  CanLine(Clock& clock, std::string name, Role role);

  /// Throws UserError (usage, device) for what waiting cannot cure. False: not there yet; it is
  /// looked for again.
  bool open(std::span<const CanFilter> filters = {});
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Of a serial adapter; nothing has been counted on other buses.
  [[nodiscard]] SlcanCounters adapter_counters() const {
    return adapter_ ? adapter_->counters() : SlcanCounters{};
  }

  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override {
    return adapter_ ? adapter_->transmit(frame) : bus_.transmit(frame);
  }
  [[nodiscard]] CanStatus status() const override {
    return adapter_ ? adapter_->status() : bus_.status();
  }

 private:
  bool open_adapter(const std::string& words);
  void look();

  Clock& clock_;
  std::string name_;
  std::string path_;
  Role role_;
  SocketCanBus bus_;
  std::optional<TermiosSerialPort> serial_;
  std::optional<SlcanBus> adapter_;  // on serial_
  FileDescriptor listener_;
  bool joined_ = false;
  Timestamp next_look_{};
};

}  // namespace picolo::tool
