// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Both ends of a socket pair that carries struct can_frame, as a raw CAN socket does.
#pragma once

#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "picolo/hal/can_bus.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::test {

/// The end of the other nodes; `take_port` gives away the port's.
class CanPair {
 public:
  CanPair() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()) != 0) {
      throw std::runtime_error("no socket pair");
    }
    port_ = FileDescriptor{ends[0]};
    other_ = FileDescriptor{ends[1]};
  }

  int take_port() { return port_.release(); }
  void close() { other_.close(); }

  template <typename Wire>
  bool send(const Wire& wire) const {
    return ::send(other_.get(), &wire, sizeof wire, MSG_DONTWAIT | MSG_NOSIGNAL) ==
           static_cast<ssize_t>(sizeof wire);
  }
  bool send(const CanFrame& frame) const {
    can_frame raw{};
    raw.can_id =
        frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
    raw.can_dlc = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
    return send<can_frame>(raw);
  }
  /// An error frame as the kernel makes it.
  bool send_error(std::uint32_t kind, std::uint8_t controller = 0) const {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | kind;
    raw.can_dlc = CAN_ERR_DLC;
    raw.data[1] = controller;
    return send<can_frame>(raw);
  }
  Result<CanFrame> receive() const {
    can_frame raw{};
    if (::recv(other_.get(), &raw, sizeof raw, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof raw)) {
      return Status::not_ready;
    }
    CanFrame frame;
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.length = raw.can_dlc;
    std::copy(std::begin(raw.data), std::end(raw.data), frame.data.begin());
    return frame;
  }

 private:
  FileDescriptor port_;
  FileDescriptor other_;
};

}  // namespace picolo::test
