// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/socket_can_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace picolo::inline v0 {
namespace {

constexpr int kMaxSkipped = 16;  // frames that are not for the caller, in one call
constexpr Duration kStampSlack = 1ms;

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::int64_t read_ns(clockid_t clock) {
  timespec time{};
  static_cast<void>(clock_gettime(clock, &time));
  return nanoseconds(time);
}

template <typename T>
T control_value(cmsghdr* header) {
  T value{};
  std::memcpy(&value, CMSG_DATA(header), sizeof value);
  return value;
}

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
  bool classic = false;  ///< size and flags of a classic frame from somebody else
  bool stamped = false;
  std::int64_t realtime_ns = 0;
};

Result<CanFrame> SocketCanBus::receive() {
  if (!socket_.is_open()) {
    status_.state = CanState::absent;
    return Status::disconnected;
  }
  for (int skipped = 0; skipped < kMaxSkipped; ++skipped) {
    if (!draining_) { begin_drain(); }
    Datagram datagram;
    const Status status = receive_datagram(datagram);
    if (!is_ok(status)) { return status; }
    if (!datagram.classic) {
      ++counters_.not_classic;
      continue;
    }
    if ((datagram.frame.can_id & CAN_ERR_FLAG) != 0) {
      handle_error_frame(datagram);
      continue;
    }
    CanFrame frame = to_frame(datagram.frame);
    frame.source = datagram.stamped ? StampSource::kernel : StampSource::read;
    frame.stamp = datagram.stamped ? map(datagram.realtime_ns, frame.source) : clock_.now();
    last_stamp_ = frame.stamp;
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
    end_drain();
    return status_.state == CanState::absent ? Status::disconnected : Status::not_ready;
  }
  if (size <= 0) { return gone(); }
  if (status_.state == CanState::absent) { status_.state = CanState::active; }
  const bool own = (message.msg_flags & MSG_CONFIRM) != 0;
  datagram.classic = size == static_cast<ssize_t>(sizeof(can_frame)) && !own;
  std::memcpy(&datagram.frame, &wire, sizeof datagram.frame);
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET) { continue; }
    if (header->cmsg_type == SCM_TIMESTAMPNS) {
      datagram.realtime_ns = nanoseconds(control_value<timespec>(header));
      datagram.stamped = true;
    }
    if (header->cmsg_type == SO_RXQ_OVFL) { count_overflow(control_value<std::uint32_t>(header)); }
  }
  return Status::ok;
}

void SocketCanBus::begin_drain() {
  // Wall time between two readings of the monotonic clock: an interruption in between costs at most
  // half of itself.
  const std::int64_t before = read_ns(CLOCK_MONOTONIC);
  const std::int64_t realtime = read_ns(CLOCK_REALTIME);
  const std::int64_t after = read_ns(CLOCK_MONOTONIC);
  realtime_minus_monotonic_ns_ = realtime - before - (after - before) / 2;
  draining_ = true;
}

void SocketCanBus::end_drain() {
  draining_ = false;
  previous_drain_ = clock_.now();
}

Timestamp SocketCanBus::map(std::int64_t realtime_ns, StampSource& source) {
  const Timestamp now = clock_.now();
  const Timestamp mapped{Duration{(realtime_ns - realtime_minus_monotonic_ns_) / 1000}};
  const bool too_old = mapped < previous_drain_ - kStampSlack;
  if (too_old || mapped > now + kStampSlack) {
    ++counters_.clock_steps;
    draining_ = false;  // the next frame gets a new pair
    source = StampSource::read;
    return now;
  }
  return std::clamp(mapped, std::min(last_stamp_, now), now);
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
  const can_frame raw = to_raw(frame);
  const ssize_t size = ::send(socket_.get(), &raw, sizeof raw, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (size == static_cast<ssize_t>(sizeof raw)) {
    ++status_.transmitted;
    if (status_.state == CanState::absent) { status_.state = CanState::active; }
    return Status::ok;
  }
  if (is_gone(errno)) { return gone(); }
  ++status_
        .tx_refused;  // ENOBUFS and EAGAIN, and anything else: never fatal, the caller tries again
  return Status::full;
}

Status SocketCanBus::gone() {
  status_.state = CanState::absent;
  end_drain();
  return Status::disconnected;
}

}  // namespace picolo::inline v0
