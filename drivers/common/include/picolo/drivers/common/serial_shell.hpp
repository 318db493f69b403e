// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The polling shell that all newer serial devices share: bytes from a port through a pure protocol
/// to samples, and the protocol's requests back to the port.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/common/serial_chunk.hpp"
#include "picolo/drivers/common/serial_counters.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0 {

/// What a device speaks. `push` takes one byte with its time and writes at most
/// kMaxSamplesPerByte samples; `interrupted`: the line was gone, what waits is void.
template <typename P>
concept SerialProtocol = requires(P& protocol, const P& fixed, std::uint8_t byte,
                                  const ByteTime& time, std::span<typename P::Sample> samples) {
  { P::kMaxSamplesPerByte } -> std::convertible_to<std::size_t>;
  { protocol.push(byte, time, samples) } -> std::same_as<std::size_t>;
  {protocol.interrupted()};
  { fixed.counters() } -> std::same_as<SerialCounters>;
};

/// A device that delivers more at once than should be copied: `pull` hands out what `push` has
/// completed.
template <typename P>
concept PullProtocol = SerialProtocol<P> &&
    requires(P& protocol, std::span<typename P::Sample> samples) {
  { protocol.pull(samples) } -> std::same_as<std::size_t>;
};

/// A device that must be asked. `request` writes the next request that is due (0 = none) and
/// `farewell` what makes the device rest; both at most kMaxRequest bytes.
template <typename P>
concept CommandedProtocol = SerialProtocol<P> &&
    requires(P& protocol, Timestamp now, std::span<std::uint8_t> bytes) {
  { P::kMaxRequest } -> std::convertible_to<std::size_t>;
  { protocol.request(now, bytes) } -> std::same_as<std::size_t>;
  { protocol.farewell(bytes) } -> std::same_as<std::size_t>;
};

/// Precondition: config.valid(). Context: one at a time. Memory: the protocol, 64 bytes of stream,
/// kMaxSamplesPerByte samples.
template <SerialProtocol Protocol>
class SerialShell {
 public:
  using Sample = typename Protocol::Sample;
  using Config = typename Protocol::Config;

  explicit SerialShell(SerialPort& port, const Config& config = {})
      : port_(port), protocol_(config) {}

  /// Reads at most `max_bytes` and writes the samples that they complete; returns how many. What
  /// finds no room waits for the next call: nothing is lost. Stamps never decrease. `not_ready`: no
  /// sample complete. `invalid_argument`: no room at all. `disconnected` and the like: from the
  /// port, after everything read before was handed out. Cost: O(max_bytes).
  [[nodiscard]] Result<std::size_t> poll(std::size_t max_bytes, std::span<Sample> samples) {
    if (samples.empty()) { return Status::invalid_argument; }
    Status status = Status::not_ready;
    std::size_t written = hand_out(samples);
    while (written < samples.size()) {
      if (next_byte_ == chunk_.size()) {
        next_byte_ = 0;
        status = chunk_.read(port_, max_bytes);
        if (!is_ok(status)) { break; }
        max_bytes -= chunk_.size();
        bytes_ += static_cast<std::uint32_t>(chunk_.size());
      }
      waiting_end_ = protocol_.push(chunk_[next_byte_], chunk_.time_of(next_byte_), waiting_);
      waiting_begin_ = 0;
      ++next_byte_;
      written += hand_out(samples.subspan(written));
    }
    if (status == Status::disconnected) { protocol_.interrupted(); }
    if (written > 0) { return written; }
    return is_ok(status) ? Status::not_ready : status;
  }

  /// Sends what the protocol asks for. Call every cycle; a port that has no room is asked again.
  /// Cost: one write.
  Status service(Timestamp now) {
    if constexpr (CommandedProtocol<Protocol>) {
      if (sent_ == request_size_) {
        sent_ = 0;
        request_size_ = protocol_.request(now, request_);
      }
      return send();
    }
    return Status::ok;
  }

  /// Makes the device rest: motor off where it has one. Call again while it answers `not_ready`.
  Status stop() {
    if constexpr (CommandedProtocol<Protocol>) {
      if (!stopping_) {
        sent_ = 0;
        request_size_ = protocol_.farewell(request_);
        stopping_ = true;
      }
      const Status status = send();
      if (is_ok(status) && sent_ < request_size_) { return Status::not_ready; }
      stopping_ = false;
      return status;
    }
    return Status::ok;
  }

  [[nodiscard]] const Protocol& protocol() const { return protocol_; }
  [[nodiscard]] SerialCounters counters() const {
    SerialCounters counters = protocol_.counters();
    counters.bytes = bytes_;
    return counters;
  }

 private:
  static constexpr std::size_t request_capacity() {
    if constexpr (CommandedProtocol<Protocol>) {
      return Protocol::kMaxRequest;
    } else {
      return 1;
    }
  }

  std::size_t hand_out(std::span<Sample> samples) {
    const std::size_t count = std::min(samples.size(), waiting_end_ - waiting_begin_);
    std::copy_n(waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_begin_), count,
                samples.begin());
    waiting_begin_ += count;
    if constexpr (PullProtocol<Protocol>) { return count + protocol_.pull(samples.subspan(count)); }
    return count;
  }

  Status send() {
    if (sent_ == request_size_) { return Status::ok; }
    const auto taken =
        port_.write(std::span<const std::uint8_t>{request_}.subspan(sent_, request_size_ - sent_));
    if (taken) { sent_ += *taken; }
    return taken.status() == Status::full ? Status::ok : taken.status();
  }

  SerialPort& port_;
  Protocol protocol_;
  SerialChunk chunk_{};
  std::size_t next_byte_ = 0;
  std::array<Sample, Protocol::kMaxSamplesPerByte> waiting_{};
  std::size_t waiting_begin_ = 0;
  std::size_t waiting_end_ = 0;
  std::array<std::uint8_t, request_capacity()> request_{};
  std::size_t request_size_ = 0;
  std::size_t sent_ = 0;
  bool stopping_ = false;
  std::uint32_t bytes_ = 0;
};

}  // namespace picolo::inline v0
