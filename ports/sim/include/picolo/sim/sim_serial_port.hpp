// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial line with two ends: the firmware's is `SerialPort`, the vehicle's delivers bytes at
/// their own times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/sim/ring.hpp"

namespace picolo::inline v0::sim {

/// Bytes arrive one by one at the line's rate; `read` gives only those that have arrived by now.
/// The line holds 16384 bytes, under way or waiting; more are lost and counted. No heap.
class SimSerialPort final : public SerialPort {
 public:
  SimSerialPort(Clock& clock, std::uint32_t baud);

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return lost_; }

  /// Vehicle side: puts bytes on the wire, not before `earliest` and not before the bytes already
  /// on it. Returns when the last of them will have arrived.
  Timestamp deliver(std::span<const std::uint8_t> bytes, Timestamp earliest);
  /// Vehicle side: bytes that the firmware wrote, oldest first; returns how many.
  std::size_t take_written(std::span<std::uint8_t> buffer);
  /// An unplugged line loses what is on it and answers every call with `disconnected`.
  void set_connected(bool connected);
  [[nodiscard]] bool connected() const { return connected_; }

  static constexpr std::size_t kReceiveCapacity = 16384;
  static constexpr std::size_t kTransmitCapacity = 1024;

 private:
  struct Burst {
    Timestamp start{};  ///< start bit of the first byte
    std::size_t size = 0;
  };
  [[nodiscard]] std::size_t arrived(const Burst& burst, Timestamp now) const;

  Clock& clock_;
  std::uint32_t baud_;
  std::uint32_t lost_ = 0;
  bool connected_ = true;
  Timestamp free_from_{};
  std::size_t consumed_ = 0;  ///< bytes of the oldest burst already read
  Ring<std::uint8_t, kReceiveCapacity> bytes_{};
  Ring<Burst, 1024> bursts_{};
  Ring<std::uint8_t, kTransmitCapacity> written_{};
};

}  // namespace picolo::inline v0::sim
