// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "picolo/linux/socket_can_bus.hpp"

namespace picolo::inline v0 {
namespace {

can_filter to_raw(const CanFilter& filter) {
  // Data frames of the right width only: RTR and the other width are tested as well.
  return {.can_id = filter.id | (filter.extended ? CAN_EFF_FLAG : 0U),
          .can_mask = filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

template <typename T>
bool set_option(int fd, int level, int name, const T& value) {
  return ::setsockopt(fd, level, name, &value, sizeof value) == 0;
}

/// Good to have, each of them: an account of what the kernel dropped, a buffer that makes it rare,
/// stamps of the kernel and of the controller.
void ask_for_more(int fd, std::int32_t buffer_bytes) {
  static_cast<void>(set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1));
  if (!set_option(fd, SOL_SOCKET, SO_RCVBUFFORCE, buffer_bytes)) {
    static_cast<void>(set_option(fd, SOL_SOCKET, SO_RCVBUF, buffer_bytes));
  }
  static_cast<void>(set_option(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1));
  const unsigned stamps = SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE |
                          SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  static_cast<void>(set_option(fd, SOL_SOCKET, SO_TIMESTAMPING, stamps));
}

}  // namespace

Status SocketCanBus::open(const char* interface_name, std::span<const CanFilter> filters,
                          std::span<const CanFilter> ours) {
  socket_.close();
  name_[0] = '\0';
  index_ = 0;
  const std::size_t length = std::strlen(interface_name);
  if (!config_.valid() || length == 0 || length >= name_.size() ||
      filters.size() + ours.size() > kMaxFilters) {
    return Status::invalid_argument;
  }
  std::memcpy(name_.data(), interface_name, length + 1);
  accepted_count_ = filters.size();
  ours_count_ = ours.size();
  const auto end = std::copy(filters.begin(), filters.end(), filters_.begin());
  std::copy(ours.begin(), ours.end(), end);
  status_.state = CanState::absent;
  next_look_ = clock_.now() + config_.retry_period;
  return connect();
}

Status SocketCanBus::set_filters(int fd) const {
  if (accepted_count_ == 0) { return Status::ok; }
  std::array<can_filter, kMaxFilters> raw{};
  const std::size_t count = accepted_count_ + ours_count_;
  std::transform(filters_.begin(), filters_.begin() + static_cast<std::ptrdiff_t>(count),
                 raw.begin(), [](const CanFilter& filter) { return to_raw(filter); });
  const auto size = static_cast<socklen_t>(count * sizeof(can_filter));
  return ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(), size) == 0 ? Status::ok
                                                                              : Status::io_error;
}

/// Binds a new socket to the interface of the stored name.
Status SocketCanBus::connect() {
  const unsigned index = ::if_nametoindex(name_.data());
  if (index == 0) { return Status::disconnected; }
  FileDescriptor socket{::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)};
  if (!socket.is_open()) {
    return errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT ? Status::unsupported
                                                             : Status::io_error;
  }
  if (!is_ok(set_filters(socket.get()))) { return Status::io_error; }
  const can_err_mask_t errors = CAN_ERR_MASK;
  static_cast<void>(set_option(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  const void* generic = &address;
  if (::bind(socket.get(), static_cast<const sockaddr*>(generic), sizeof address) != 0) {
    return errno == ENODEV ? Status::disconnected : Status::io_error;
  }
  index_ = index;
  return set_up(socket.release());
}

Status SocketCanBus::adopt(int fd) {
  name_[0] = '\0';
  return set_up(fd);
}

Status SocketCanBus::set_up(int fd) {
  socket_ = FileDescriptor{fd};
  const int flags = ::fcntl(fd, F_GETFL);
  if (flags < 0 || ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) != 0) {
    socket_.close();
    return Status::io_error;
  }
  ask_for_more(fd, config_.receive_buffer_bytes);
  status_.state = CanState::active;
  overflow_total_ = 0;
  stamps_.reset(clock_.now());
  return Status::ok;
}

bool SocketCanBus::link_has(unsigned flags) const {
  ifreq request{};
  std::memcpy(request.ifr_name, name_.data(), name_.size());
  if (::ioctl(socket_.get(), SIOCGIFFLAGS, &request) != 0) { return false; }
  return (static_cast<unsigned>(request.ifr_flags) & flags) == flags;
}

/// While the bus is gone or off: has that changed? An interface of the same name with another index
/// was made anew, and the old socket will never hear of it.
void SocketCanBus::look_again() {
  const Timestamp now = clock_.now();
  if (name_[0] == '\0' || now < next_look_) { return; }
  next_look_ = now + config_.retry_period;
  if (!socket_.is_open() || ::if_nametoindex(name_.data()) != index_) {
    const bool was_open = index_ != 0;
    if (!is_ok(connect())) { return; }
    counters_.reopened += was_open ? 1U : 0U;
    if (!link_has(IFF_UP)) { status_.state = CanState::absent; }
    return;
  }
  if (status_.state == CanState::absent && link_has(IFF_UP)) { status_.state = CanState::active; }
  if (status_.state == CanState::bus_off && link_has(IFF_UP | IFF_RUNNING)) {
    // The carrier is back, though its error frame has not reached us.
    ++status_.restarts;
    status_.state = CanState::active;
  }
}

std::int32_t SocketCanBus::receive_buffer_bytes() const {
  std::int32_t bytes = 0;
  socklen_t size = sizeof bytes;
  static_cast<void>(::getsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size));
  return bytes;
}

}  // namespace picolo::inline v0
