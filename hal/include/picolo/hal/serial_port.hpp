// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One serial line, as drivers see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

/// What one `read` delivered.
struct SerialRead {
  std::size_t size = 0;         ///< bytes written into the caller's buffer
  Timestamp last_byte_stamp{};  ///< when the last of these bytes had arrived
  StampSource source = StampSource::read;
};

/// One serial line of raw bytes, 8N1. Never blocks; all calls from one context.
/// Ports are held to this by hal/conformance/serial_port.hpp.
class SerialPort {
 public:
  /// Copies waiting bytes, oldest first, at most `buffer.size()`; stamps never decrease. At least
  /// 256 bytes may wait. `not_ready`: none wait, or the buffer is empty. `disconnected`: the device
  /// is gone; may come back.
  virtual Result<SerialRead> read(std::span<std::uint8_t> buffer) = 0;
  /// Queues bytes and returns how many were taken (may be fewer). `full`: none. `disconnected`: as
  /// above.
  virtual Result<std::size_t> write(std::span<const std::uint8_t> bytes) = 0;
  /// Bits per second of the line, for drivers that compute when a byte began. Never 0.
  [[nodiscard]] virtual std::uint32_t baud() const = 0;
  /// Bytes lost before `read` (full ring or hardware overrun); never reset.
  [[nodiscard]] virtual std::uint32_t lost() const = 0;

 protected:
  SerialPort() = default;
  SerialPort(const SerialPort&) = default;
  SerialPort& operator=(const SerialPort&) = default;
  ~SerialPort() = default;
};

/// Time on the wire of `bytes` bytes at 8N1, rounded down to microseconds.
[[nodiscard]] constexpr Duration transmission_time(std::size_t bytes, std::uint32_t baud) {
  return Duration{static_cast<std::int64_t>(bytes) * 10'000'000 / static_cast<std::int64_t>(baud)};
}

}  // namespace picolo::inline v0
