// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// SLCAN: CAN frames as lines of text on a serial line. The Lawicel CANUSB protocol (CANUSB manual,
/// version 1.0), as CANable, CANtact, USBtin and many more speak it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0::slcan {

inline constexpr std::uint8_t kEnd = '\r';
inline constexpr std::uint8_t kRefused = '\a';
[[nodiscard]] constexpr bool ends_line(std::uint8_t byte) {
  return byte == kEnd || byte == kRefused;
}

/// A line to the adapter or from it, its end not included.
class Line {
 public:
  /// T, 29-bit identifier, length, 8 bytes, the adapter's own time.
  static constexpr std::size_t kCapacity = 1 + 8 + 1 + 16 + 4;
  [[nodiscard]] ByteView view() const { return {bytes_.data(), size_}; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// False when full; nothing is changed then.
  [[nodiscard]] bool add(std::uint8_t byte) {
    if (size_ == bytes_.size()) { return false; }
    bytes_[size_] = byte;
    ++size_;
    return true;
  }
  void clear() { size_ = 0; }

 private:
  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t size_ = 0;
};

/// t123 2 11 22: type and identifier, length, data; r and R are requests without data.
/// Precondition: `frame` is possible: length at most 8, identifier in its range.
[[nodiscard]] Line encode(const CanFrame& frame);

/// The frame of a line; its stamp is not set. `not_ready`: an answer of the adapter's, no frame.
/// `invalid_argument`: neither, bytes are missing or damaged.
[[nodiscard]] Result<CanFrame> decode(ByteView line);

/// Cuts a stream of bytes into lines.
class LineCutter {
 public:
  enum class Event : std::uint8_t {
    none,      ///< inside a line
    line,      ///< `line()` is whole, until the next byte
    refused,   ///< the adapter did not like a command
    overlong,  ///< longer than any line of the protocol: ends are missing
  };
  Event add(std::uint8_t byte);
  /// What came since the last end is damaged; goes on behind the next end.
  void spoil() { spoilt_ = true; }
  [[nodiscard]] ByteView line() const { return line_.view(); }

 private:
  Line line_{};
  bool ended_ = false;
  bool spoilt_ = false;
};

}  // namespace picolo::inline v0::slcan
