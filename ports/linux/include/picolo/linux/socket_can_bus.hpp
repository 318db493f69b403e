// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// SocketCAN.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/linux/file_descriptor.hpp"
#include "picolo/linux/kernel_stamps.hpp"

namespace picolo::inline v0 {

struct SocketCanConfig {
  /// Asked of the kernel, which grants less to programs without CAP_NET_ADMIN. Its default holds
  /// 35 ms of a full bus of 1 Mbit/s.
  std::int32_t receive_buffer_bytes = 1'048'576;
  Duration retry_period = 500ms;  ///< how often a bus that is gone, or off, is looked for
  [[nodiscard]] constexpr bool valid() const {
    return receive_buffer_bytes > 0 && retry_period > Duration{0};
  }
};

/// What goes beyond CanStatus. Never reset.
struct SocketCanCounters {
  std::uint32_t not_classic = 0;      ///< CAN FD frames and torn datagrams; ignored
  std::uint32_t own_frames = 0;       ///< own frames that came back; ignored
  std::uint32_t foreign_talkers = 0;  ///< frames of others on identifiers of ours; kept out
  std::uint32_t reopened = 0;         ///< the interface was deleted and made anew
};

/// A raw CAN socket. Stamps: see StampMapper. Error frames become `status().state`. While the
/// interface is down, deleted, or not yet there, calls answer `disconnected`; `receive` finds it
/// again within the retry period, and frames that come earlier are not lost after `down` and `up`.
/// A bus that is off takes no frames (`full`) until the kernel restarts it.
/// No heap. Cost: one system call each; a few more per retry period while gone.
class SocketCanBus final : public CanBus {
 public:
  static constexpr std::size_t kMaxFilters = 64;

  explicit SocketCanBus(Clock& clock, const SocketCanConfig& config = {})
      : clock_(clock), config_(config) {}

  /// Opens an interface, e.g. "can0", and delivers what one of `filters` accepts; none given:
  /// everything. `ours`: identifiers on which nobody else may send; such frames are counted and
  /// kept out. `disconnected`: no such interface now, `receive` goes on looking for it.
  /// `invalid_argument`: configuration, name, or more than kMaxFilters. `unsupported`: the kernel
  /// has no CAN. `io_error`: errno says why.
  Status open(const char* interface_name, std::span<const CanFilter> filters = {},
              std::span<const CanFilter> ours = {});
  /// Takes over a bound CAN socket, or anything that carries `struct can_frame` in datagrams (a
  /// socket pair); it is not opened again. `io_error`: errno says why.
  Status adopt(int fd);
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }
  /// For poll and epoll; negative: none. Changes when the interface was made anew.
  [[nodiscard]] int descriptor() const { return socket_.get(); }

  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override { return status_; }
  [[nodiscard]] const SocketCanCounters& counters() const { return counters_; }
  [[nodiscard]] const StampMapper& stamps() const { return stamps_; }
  /// What the kernel granted, in its own account (twice the bytes that were asked for).
  [[nodiscard]] std::int32_t receive_buffer_bytes() const;

 private:
  struct Datagram;
  Status connect();
  Status set_up(int fd);
  Status set_filters(int fd) const;
  void look_again();
  [[nodiscard]] bool link_has(unsigned flags) const;
  Status receive_datagram(Datagram& datagram);
  [[nodiscard]] bool is_for_caller(const Datagram& datagram);
  [[nodiscard]] MappedStamp stamp(const KernelStamps& stamps);
  void handle_error_frame(const Datagram& datagram);
  void heard_something();
  void count_overflow(std::uint32_t total);
  Status gone();

  Clock& clock_;
  SocketCanConfig config_;
  FileDescriptor socket_{};
  CanStatus status_{};
  SocketCanCounters counters_{};
  StampMapper stamps_{};
  std::array<char, 16> name_{};                   ///< empty: adopted
  unsigned index_ = 0;                            ///< of the interface that the socket is bound to
  std::array<CanFilter, kMaxFilters> filters_{};  ///< the caller's, then ours
  std::size_t accepted_count_ = 0;
  std::size_t ours_count_ = 0;
  Timestamp next_look_{};
  std::uint32_t overflow_total_ = 0;  ///< as the kernel last reported it
};

}  // namespace picolo::inline v0
