// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What all dialects of the simulated vehicle share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "picolo/devices/dialects.hpp"
#include "picolo/drivers/common/serial_chunk.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0::devices {

using Bytes = std::vector<std::uint8_t>;

/// Reads the simulated device, hands each of its bytes to `translate`, and delivers what that says
/// with the same stamps.
class Dialect : public SerialPort {
 public:
  explicit Dialect(SerialPort& inner) : inner_(inner) {}
  virtual ~Dialect() = default;

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    if (buffer.empty()) { return Status::not_ready; }
    while (pending_.empty()) {
      const Status status = chunk_.read(inner_, SerialChunk::kCapacity);
      if (!is_ok(status)) { return status; }
      for (std::size_t i = 0; i < chunk_.size(); ++i) { translate(chunk_[i], chunk_.time_of(i)); }
    }
    Burst& burst = pending_.front();
    const std::size_t size = std::min(buffer.size(), burst.bytes.size() - burst.taken);
    std::copy_n(burst.bytes.begin() + static_cast<std::ptrdiff_t>(burst.taken), size,
                buffer.begin());
    burst.taken += size;
    const std::size_t left = burst.bytes.size() - burst.taken;
    const SerialRead result{size, burst.stamp - transmission_time(left, baud()),
                            StampSource::hardware};
    if (left == 0) { pending_.pop_front(); }
    return result;
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) { obey(byte); }
    return bytes.size();
  }
  [[nodiscard]] std::uint32_t baud() const override { return 2 * inner_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return inner_.lost(); }

 protected:
  virtual void translate(std::uint8_t byte, const ByteTime& time) = 0;
  virtual void obey(std::uint8_t /*byte*/) {}
  void say(const Bytes& bytes, Timestamp stamp) {
    last_ = std::max(last_, stamp);
    pending_.push_back({bytes, last_, 0});
  }
  [[nodiscard]] Timestamp last() const { return last_; }

 private:
  struct Burst {
    Bytes bytes;
    Timestamp stamp{};
    std::size_t taken = 0;
  };
  SerialPort& inner_;
  SerialChunk chunk_{};
  std::deque<Burst> pending_;
  Timestamp last_{};
};

inline void add_u16(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>((value >> 8U) & 0xFFU));
}

class LidarDialect : public Dialect {
 public:
  using Dialect::Dialect;

 protected:
  virtual void packet(const Ld06Packet& packet, Timestamp stamp) = 0;

 private:
  void translate(std::uint8_t byte, const ByteTime& time) override {
    if (is_ok(decoder_.push(byte))) { packet(decoder_.packet(), time.arrived); }
  }
  Ld06Decoder decoder_{};
};

class PassingLine final : public Dialect {
 public:
  using Dialect::Dialect;

 private:
  void translate(std::uint8_t byte, const ByteTime& time) override { say({byte}, time.arrived); }
};

template <typename Port, typename... Args>
SerialPortPointer make_port(Args&&... args) {
  return SerialPortPointer{new Port(std::forward<Args>(args)...),
                           [](SerialPort* port) { delete static_cast<Port*>(port); }};
}

[[nodiscard]] SerialPortPointer make_scip_dialect(SerialPort& ld06);
/// Throws std::invalid_argument.
[[noreturn]] void refuse_dialect(const std::string& name);

}  // namespace picolo::inline v0::devices
