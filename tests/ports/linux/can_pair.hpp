// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Both ends of a socket pair that carries struct can_frame, as a raw CAN socket does.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "picolo/hal/can_bus.hpp"
#include "picolo/linux/file_descriptor.hpp"
#include "support/raw_can_frame.hpp"

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
  bool send(const CanFrame& frame) const { return send(raw_frame(frame)); }
  bool send_error(std::uint32_t kind, std::uint8_t controller = 0) const {
    return send(raw_error(kind, controller));
  }
  Result<CanFrame> receive() const {
    can_frame raw{};
    if (::recv(other_.get(), &raw, sizeof raw, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof raw)) {
      return Status::not_ready;
    }
    return frame_of(raw);
  }

 private:
  FileDescriptor port_;
  FileDescriptor other_;
};

}  // namespace picolo::test
