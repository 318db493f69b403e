// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial line on Linux: a UART, a USB adapter or a pseudo-terminal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::inline v0 {

struct TermiosConfig {
  std::uint32_t baud = 115'200;   ///< any rate that the adapter can do
  Duration retry_period = 500ms;  ///< how often `read` looks for a device that has gone
  /// Level of the DTR line while open, where the adapter has one: the motor of a YDLIDAR turns
  /// while it is up, that of an RPLIDAR A1 while it is down.
  bool dtr = true;
  [[nodiscard]] constexpr bool valid() const { return baud > 0 && retry_period > Duration{0}; }
};

/// Raw mode, 8N1, no flow control, non-blocking; short latency where the adapter offers it. Stamps
/// are the time of the read. A device that is unplugged answers `disconnected`; `read` opens it
/// again under the same path when it has come back (a link of /dev/serial/by-id stays the same
/// wherever an adapter is plugged in). Paths are kept in the object (255 characters);
/// no heap.
class TermiosSerialPort final : public SerialPort {
 public:
  TermiosSerialPort(Clock& clock, const TermiosConfig& config) : clock_(clock), config_(config) {}

  /// `invalid_argument`: configuration or path. `unsupported`: the device is no terminal, or its
  /// driver says that it cannot do this rate within 3 %. `io_error`: errno says why. Bytes that
  /// came before are thrown away.
  Status open(const char* path);
  /// Takes over an open terminal; it is not opened again after it has gone. Status as above.
  Status adopt(int fd);
  /// Another rate, also for every later opening. What came at the old one is void: the next `read`
  /// answers `disconnected` once. `unsupported`: the adapter cannot do it; the old rate stays.
  Status set_baud(std::uint32_t baud);
  [[nodiscard]] bool is_open() const { return device_.is_open(); }

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return config_.baud; }
  /// What the driver of the UART counts as overruns; 0 where it does not count.
  [[nodiscard]] std::uint32_t lost() const override;

  /// Whether the driver promises to hand bytes on at once. False for adapters that hold them back
  /// (FTDI without it: 16 ms), and for those that do not tell.
  [[nodiscard]] bool low_latency() const;
  /// For poll and epoll; negative: none. Changes when the device has come back.
  [[nodiscard]] int descriptor() const { return device_.get(); }
  /// How often the device has gone.
  [[nodiscard]] std::uint32_t disconnects() const { return disconnects_; }

 private:
  Status try_open();
  Status set_up(FileDescriptor device);
  void lose_device();
  [[nodiscard]] std::uint32_t overruns() const;

  Clock& clock_;
  TermiosConfig config_;
  FileDescriptor device_{};
  std::array<char, 256> path_{};
  bool rate_changed_ = false;
  Timestamp next_try_{};
  std::uint32_t disconnects_ = 0;
  std::uint32_t lost_before_ = 0;  ///< on devices that have gone since
  std::uint32_t overruns_at_open_ = 0;
};

}  // namespace picolo::inline v0
