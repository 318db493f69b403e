// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// SocketCAN.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::inline v0 {

/// What goes beyond CanStatus. Never reset.
struct SocketCanCounters {
  std::uint32_t not_classic = 0;  ///< CAN FD frames and others that are no classic frame; ignored
  std::uint32_t clock_steps =
      0;  ///< frames whose kernel stamp did not fit, stamped with the time of the read
};

/// A raw CAN socket. Kernel stamps are taken in wall time and mapped to the monotonic clock by a
/// pair of both, taken anew for each drain (the calls of `receive` up to `not_ready`): a step of
/// the wall clock spoils at most the frames of one drain, and that is noticed, since they must have
/// arrived after the previous one. Once the interface is gone or down, it is `disconnected` until a
/// frame passes again in either direction.
class SocketCanBus final : public CanBus {
 public:
  explicit SocketCanBus(Clock& clock) : clock_(clock) {}

  /// Opens a raw socket on an interface, e.g. "can0", that passes what one of `filters` accepts;
  /// none given: everything. `disconnected`: no such interface. `unsupported`: the kernel has no
  /// CAN. `io_error`: errno says why.
  Status open(const char* interface_name, std::span<const CanFilter> filters = {});
  /// Takes over a bound CAN socket, or anything that carries `struct can_frame` in datagrams (a
  /// socket pair). `io_error`: errno says why.
  Status adopt(int fd);
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }

  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override { return status_; }
  [[nodiscard]] const SocketCanCounters& counters() const { return counters_; }

 private:
  struct Datagram;
  Status receive_datagram(Datagram& datagram);
  void begin_drain();
  void end_drain();
  [[nodiscard]] Timestamp map(std::int64_t realtime_ns, StampSource& source);
  void handle_error_frame(const Datagram& datagram);
  void count_overflow(std::uint32_t total);
  Status gone();

  Clock& clock_;
  FileDescriptor socket_{};
  CanStatus status_{};
  SocketCanCounters counters_{};
  bool draining_ = false;
  std::int64_t realtime_minus_monotonic_ns_ = 0;  ///< of this drain
  Timestamp previous_drain_{};                    ///< when the queue was last seen empty
  Timestamp last_stamp_{};
  std::uint32_t overflow_total_ = 0;  ///< as the kernel last reported it
};

}  // namespace picolo::inline v0
