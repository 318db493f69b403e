// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "can_node.hpp"

#include <gtest/gtest.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/raw_can_frame.hpp"

namespace picolo::test {
namespace {

constexpr int kPatienceMs = 1000;

template <typename Wire>
bool send_wire(int socket, const Wire& wire) {
  // Wait for room: a controller's queue is short.
  pollfd ready{.fd = socket, .events = POLLOUT, .revents = 0};
  for (int i = 0; i < 100; ++i) {
    static_cast<void>(::poll(&ready, 1, kPatienceMs));
    if (::send(socket, &wire, sizeof wire, 0) == static_cast<ssize_t>(sizeof wire)) { return true; }
    if (errno != ENOBUFS) { return false; }
    ::usleep(1000);
  }
  return false;
}

}  // namespace

CanNode::CanNode(const std::string& interface)
    : socket_(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
  const int on = 1;
  static_cast<void>(::setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  const void* generic = &address;
  const bool bound =
      address.can_ifindex > 0 &&
      ::bind(socket_.get(), static_cast<const sockaddr*>(generic), sizeof address) == 0;
  EXPECT_TRUE(bound) << interface;
}

bool CanNode::send(const can_frame& frame) const {
  return send_wire(socket_.get(), frame);
}
bool CanNode::send(const canfd_frame& frame) const {
  return send_wire(socket_.get(), frame);
}

bool CanNode::send(const CanFrame& frame) const {
  return send(raw_frame(frame));
}

bool CanNode::send_error(std::uint32_t kind, std::uint8_t controller) const {
  return send(raw_error(kind, controller));
}

Result<CanFrame> CanNode::receive(Duration patience) const {
  pollfd ready{.fd = socket_.get(), .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, static_cast<int>(patience.count() / 1000)) != 1) {
    return Status::not_ready;
  }
  can_frame raw{};
  if (::recv(socket_.get(), &raw, sizeof raw, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof raw)) {
    return Status::not_ready;
  }
  return frame_of(raw);
}

Result<CanFrame> next(CanBus& bus) {
  for (int i = 0; i < kPatienceMs; ++i) {
    const Result<CanFrame> frame = bus.receive();
    if (frame.status() != Status::not_ready) { return frame; }
    ::usleep(1000);
  }
  return Status::not_ready;
}

void settle() {
  ::usleep(20'000);
}

}  // namespace picolo::test
