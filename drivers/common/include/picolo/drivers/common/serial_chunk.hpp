// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A piece of a serial stream on the stack of a polling shell, with the time of each of its bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0 {

/// When one byte of a stream had arrived.
struct ByteTime {
  Timestamp arrived{};
  StampSource source = StampSource::read;
  std::uint32_t baud = 1;
  /// When the first bit of the last `bytes` bytes, this one included, went onto the wire.
  [[nodiscard]] constexpr Timestamp first_bit(std::size_t bytes) const {
    return arrived - transmission_time(bytes, baud);
  }
};

/// Cost: one `read` of at most 64 bytes. Context: one at a time.
class SerialChunk {
 public:
  static constexpr std::size_t kCapacity = 64;

  /// Replaces the chunk by up to `limit` waiting bytes. `not_ready`: none wait, or limit is 0. Else
  /// the port's status.
  Status read(SerialPort& port, std::size_t limit) {
    size_ = 0;
    if (limit == 0) { return Status::not_ready; }
    const auto got = port.read(std::span{bytes_}.first(std::min(limit, kCapacity)));
    if (!got) { return got.status(); }
    if (got->size == 0) { return Status::not_ready; }
    size_ = got->size;
    stamp_ = got->last_byte_stamp;
    source_ = got->source;
    baud_ = port.baud();
    return Status::ok;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint8_t operator[](std::size_t index) const { return bytes_[index]; }
  [[nodiscard]] StampSource source() const { return source_; }

  [[nodiscard]] ByteTime time_of(std::size_t index) const {
    return {.arrived = stamp_ - transmission_time(size_ - 1 - index, baud_),
            .source = source_,
            .baud = baud_};
  }

  /// When the first bit of a frame went onto the wire whose last byte is byte `last` of this chunk.
  [[nodiscard]] Timestamp first_bit(std::size_t last, std::size_t frame_size) const {
    return stamp_ - transmission_time(size_ - 1 - last + frame_size, baud_);
  }

 private:
  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t size_ = 0;
  Timestamp stamp_{};
  StampSource source_ = StampSource::read;
  std::uint32_t baud_ = 1;
};

/// How many bytes can be read so that at most `frames` frames of `frame_size` bytes complete when
/// `pending` bytes of one are there already. Precondition: pending < frame_size.
[[nodiscard]] constexpr std::size_t bytes_for_frames(std::size_t frames, std::size_t frame_size,
                                                     std::size_t pending) {
  return frames * frame_size + frame_size - 1 - pending;
}

static_assert(bytes_for_frames(0, 47, 46) == 0 && bytes_for_frames(1, 11, 3) == 18);

}  // namespace picolo::inline v0
