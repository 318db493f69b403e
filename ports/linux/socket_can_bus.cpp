// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/socket_can_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace picolo::inline v0 {
namespace {

constexpr int kMaxSkipped = 16;  // frames that are not for the caller, in one call

bool is_gone(int error) {
  return error == ENETDOWN || error == ENODEV || error == ENXIO || error == EPIPE ||
         error == ECONNRESET || error == ENOTCONN || error == EBADF || error == ECONNREFUSED;
}

CanFrame to_frame(const can_frame& raw) {
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = std::min<std::uint8_t>(raw.can_dlc, 8);
  std::copy_n(std::begin(raw.data), 8, frame.data.begin());
  return frame;
}

can_frame to_raw(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.length;
  if (!frame.remote) { std::copy_n(frame.data.begin(), frame.length, std::begin(raw.data)); }
  return raw;
}

bool has_classic_shape(const CanFrame& frame) {
  return frame.length <= 8 && frame.id <= (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
}

}  // namespace

struct SocketCanBus::Datagram {
  can_frame frame{};
  bool classic = false;  ///< has the size of a classic frame
  bool own = false;
  KernelStamps stamps{};
};

Result<CanFrame> SocketCanBus::receive() {
  if (status_.state == CanState::absent || status_.state == CanState::bus_off) { look_again(); }
  if (!socket_.is_open()) {
    status_.state = CanState::absent;
    return Status::disconnected;
  }
  for (int skipped = 0; skipped < kMaxSkipped; ++skipped) {
    if (!stamps_.draining()) { stamps_.begin_drain(realtime_minus_monotonic_ns()); }
    Datagram datagram;
    const Status status = receive_datagram(datagram);
    if (!is_ok(status)) { return status; }
    if (!is_for_caller(datagram)) { continue; }
    CanFrame frame = to_frame(datagram.frame);
    const MappedStamp mapped = stamp(datagram.stamps);
    frame.stamp = mapped.stamp;
    frame.source = mapped.source;
    ++status_.received;
    return frame;
  }
  return Status::not_ready;
}

Status SocketCanBus::receive_datagram(Datagram& datagram) {
  canfd_frame wire{};  // room for the larger kind
  alignas(cmsghdr) std::array<std::uint8_t, 256> control{};
  iovec vector{.iov_base = &wire, .iov_len = sizeof wire};
  msghdr message{};
  message.msg_iov = &vector;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
    stamps_.end_drain(clock_.now());
    return status_.state == CanState::absent ? Status::disconnected : Status::not_ready;
  }
  if (size <= 0) { return gone(); }
  datagram.classic = size == static_cast<ssize_t>(sizeof(can_frame));
  datagram.own = (message.msg_flags & MSG_CONFIRM) != 0;
  std::memcpy(&datagram.frame, &wire, sizeof datagram.frame);
  datagram.stamps = kernel_stamps(message);
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SO_RXQ_OVFL) { continue; }
    std::uint32_t total = 0;
    std::memcpy(&total, CMSG_DATA(header), sizeof total);
    count_overflow(total);
  }
  return Status::ok;
}

bool SocketCanBus::is_for_caller(const Datagram& datagram) {
  if (datagram.own) {
    ++counters_.own_frames;
    return false;
  }
  if (!datagram.classic) {
    ++counters_.not_classic;
    return false;
  }
  if ((datagram.frame.can_id & CAN_ERR_FLAG) != 0) {
    handle_error_frame(datagram);
    return false;
  }
  heard_something();
  const CanFrame frame = to_frame(datagram.frame);
  for (std::size_t i = accepted_count_; i < accepted_count_ + ours_count_; ++i) {
    if (filters_[i].accepts(frame.id, frame.extended) && !frame.remote) {
      ++counters_.foreign_talkers;
      return false;
    }
  }
  return true;
}

/// A frame got through: the bus is there, whatever was last told about it.
void SocketCanBus::heard_something() {
  if (status_.state == CanState::bus_off) { ++status_.restarts; }
  if (status_.state == CanState::absent || status_.state == CanState::bus_off) {
    status_.state = CanState::active;
  }
}

MappedStamp SocketCanBus::stamp(const KernelStamps& stamps) {
  if (stamps_.wants_offset(stamps, clock_.now())) {
    stamps_.begin_drain(realtime_minus_monotonic_ns());
  }
  return stamps_.map(stamps, clock_.now());
}

void SocketCanBus::handle_error_frame(const Datagram& datagram) {
  ++status_.error_frames;
  const std::uint32_t kind = datagram.frame.can_id;
  const std::uint8_t controller = datagram.frame.data[1];
  if ((kind & CAN_ERR_CRTL) != 0) {
    if ((controller & (CAN_ERR_CRTL_RX_OVERFLOW)) != 0) { ++status_.rx_lost; }
    if ((controller & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
      status_.state = CanState::warning;
    }
    if ((controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      status_.state = CanState::passive;
    }
    if ((controller & CAN_ERR_CRTL_ACTIVE) != 0) { status_.state = CanState::active; }
  }
  if ((kind & CAN_ERR_BUSOFF) != 0) { status_.state = CanState::bus_off; }
  if ((kind & CAN_ERR_RESTARTED) != 0) {
    ++status_.restarts;
    status_.state = CanState::active;
  }
}

/// The kernel counts per socket, without end; it tells with the next frame that it can deliver.
void SocketCanBus::count_overflow(std::uint32_t total) {
  status_.rx_lost += total - overflow_total_;
  overflow_total_ = total;
}

Status SocketCanBus::transmit(const CanFrame& frame) {
  if (!has_classic_shape(frame)) { return Status::invalid_argument; }
  if (!socket_.is_open()) { return Status::disconnected; }
  if (status_.state == CanState::bus_off) {
    ++status_.tx_refused;  // the kernel would take it and throw it away
    return Status::full;
  }
  const can_frame raw = to_raw(frame);
  const ssize_t size = ::send(socket_.get(), &raw, sizeof raw, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (size == static_cast<ssize_t>(sizeof raw)) {
    ++status_.transmitted;
    if (status_.state == CanState::absent) { status_.state = CanState::active; }
    return Status::ok;
  }
  if (is_gone(errno)) { return gone(); }
  // ENOBUFS and EAGAIN, and anything else: never fatal, the caller tries again.
  ++status_.tx_refused;
  return Status::full;
}

Status SocketCanBus::gone() {
  if (status_.state != CanState::absent) { next_look_ = clock_.now() + config_.retry_period; }
  status_.state = CanState::absent;
  stamps_.end_drain(clock_.now());
  return Status::disconnected;
}

}  // namespace picolo::inline v0
