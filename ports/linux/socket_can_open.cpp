// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "picolo/linux/socket_can_bus.hpp"

namespace picolo::inline v0 {
namespace {

constexpr int kReceiveBufferBytes = 1'048'576;  // the default holds 35 ms of a full 1 Mbit/s bus

can_filter to_raw(const CanFilter& filter) {
  // Data frames of the right width only: RTR and the other width are tested as well.
  return {.can_id = filter.id | (filter.extended ? CAN_EFF_FLAG : 0U),
          .can_mask = filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

}  // namespace

Status SocketCanBus::open(const char* interface_name, std::span<const CanFilter> filters) {
  constexpr std::size_t kMaxFilters = 64;
  std::array<can_filter, kMaxFilters> raw{};
  if (filters.size() > kMaxFilters) { return Status::invalid_argument; }
  const unsigned index = ::if_nametoindex(interface_name);
  if (index == 0) { return Status::disconnected; }
  FileDescriptor socket{::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)};
  if (!socket.is_open()) {
    return errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT ? Status::unsupported
                                                             : Status::io_error;
  }
  if (!filters.empty()) {
    std::transform(filters.begin(), filters.end(), raw.begin(),
                   [](const CanFilter& filter) { return to_raw(filter); });
    const auto size = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
    if (::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(), size) != 0) {
      return Status::io_error;
    }
  }
  const can_err_mask_t errors = CAN_ERR_MASK;
  static_cast<void>(
      ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  const void* generic = &address;
  if (::bind(socket.get(), static_cast<const sockaddr*>(generic), sizeof address) != 0) {
    return errno == ENODEV ? Status::disconnected : Status::io_error;
  }
  return adopt(socket.release());
}

Status SocketCanBus::adopt(int fd) {
  socket_ = FileDescriptor{fd};
  const int flags = ::fcntl(fd, F_GETFL);
  const int on = 1;
  if (flags < 0 || ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) != 0 ||
      ::setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0) {
    socket_.close();
    return Status::io_error;
  }
  // Good to have: an account of what the kernel dropped, and a buffer that makes it rare.
  static_cast<void>(::setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on));
  static_cast<void>(
      ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes));
  status_.state = CanState::active;
  overflow_total_ = 0;
  draining_ = false;
  previous_drain_ = clock_.now();
  return Status::ok;
}

}  // namespace picolo::inline v0
