// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial line that plays a scenario: chunks of bytes arrive with the stamp of their last byte.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "picolo/hal/serial_port.hpp"

namespace picolo::test {

/// One `read` never crosses the border between two chunks; a read that leaves bytes of its chunk
/// behind is stamped earlier by their time on the wire.
class FakeSerialPort final : public SerialPort {
 public:
  explicit FakeSerialPort(std::uint32_t baud = 230400) : baud_(baud) {}

  void arrives(Timestamp last_byte_stamp, std::span<const std::uint8_t> bytes) {
    if (!bytes.empty()) { chunks_.push_back({last_byte_stamp, {bytes.begin(), bytes.end()}, 0}); }
  }
  /// The device is gone: waiting bytes are lost, every call fails, until `reconnect`.
  void disconnect() {
    chunks_.clear();
    connected_ = false;
  }
  void reconnect() { connected_ = true; }
  /// From now on `write` takes at most this many bytes a call; 0 answers `full`.
  void takes_at_most(std::size_t bytes) { write_limit_ = bytes; }
  void loses(std::uint32_t bytes) { lost_ += bytes; }
  void stamps_come_from(StampSource source) { source_ = source; }

  [[nodiscard]] std::size_t waiting() const {
    std::size_t bytes = 0;
    for (const Chunk& chunk : chunks_) { bytes += chunk.bytes.size() - chunk.taken; }
    return bytes;
  }
  [[nodiscard]] const std::vector<std::uint8_t>& written() const { return written_; }

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    if (!connected_) { return Status::disconnected; }
    if (chunks_.empty() || buffer.empty()) { return Status::not_ready; }
    Chunk& chunk = chunks_.front();
    const std::size_t left = chunk.bytes.size() - chunk.taken;
    const std::size_t size = std::min(buffer.size(), left);
    std::copy_n(chunk.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.taken), size,
                buffer.begin());
    chunk.taken += size;
    const SerialRead result{size, chunk.stamp - transmission_time(left - size, baud_), source_};
    if (size == left) { chunks_.pop_front(); }
    return result;
  }

  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    if (!connected_) { return Status::disconnected; }
    const std::size_t size = std::min(bytes.size(), write_limit_);
    if (size == 0) { return Status::full; }
    written_.insert(written_.end(), bytes.begin(),
                    bytes.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }

  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return lost_; }

 private:
  struct Chunk {
    Timestamp stamp{};
    std::vector<std::uint8_t> bytes;
    std::size_t taken = 0;
  };

  std::uint32_t baud_;
  std::deque<Chunk> chunks_;
  std::vector<std::uint8_t> written_;
  std::size_t write_limit_ = SIZE_MAX;
  std::uint32_t lost_ = 0;
  StampSource source_ = StampSource::kernel;
  bool connected_ = true;
};

}  // namespace picolo::test
