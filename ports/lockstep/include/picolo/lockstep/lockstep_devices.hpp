// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// HAL interfaces that hold what one packet brought.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/core/fixed_vector.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo::inline v0::lockstep {

/// Stands still within a frame.
class LockstepClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() override { return now_; }
  void set(Timestamp now) { now_ = now; }

 private:
  Timestamp now_{};
};

class LockstepCanBus final : public CanBus {
 public:
  static constexpr std::size_t kFrames = 64;
  static constexpr std::size_t kSent = 32;  ///< in one minor frame
  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override { return status_; }

  /// What waits stays, what was sent is forgotten.
  void begin_frame();
  void arrives(const CanFrame& frame);
  [[nodiscard]] std::span<const CanFrame> sent() const { return sent_.view(); }

 private:
  FixedVector<CanFrame, kFrames> waiting_{};
  std::size_t next_ = 0;
  FixedVector<CanFrame, kSent> sent_{};
  CanStatus status_{};
};

class LockstepSerialPort final : public SerialPort {
 public:
  static constexpr std::size_t kBytes = 1024;
  explicit LockstepSerialPort(std::uint32_t baud) : baud_(baud) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  /// Takes all and keeps nothing: no device of a lockstep run listens.
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return lost_; }

  void begin_frame();
  void arrives(std::uint8_t byte, Timestamp stamp);

 private:
  struct StampedByte {
    Timestamp stamp{};
    std::uint8_t byte = 0;
  };
  FixedVector<StampedByte, kBytes> waiting_{};
  std::size_t next_ = 0;
  std::uint32_t baud_;
  std::uint32_t lost_ = 0;
};

class LockstepWatchdog final : public Watchdog {
 public:
  void stroke() override { ++strokes_; }
  [[nodiscard]] std::uint32_t strokes() const { return strokes_; }

 private:
  std::uint32_t strokes_ = 0;
};

}  // namespace picolo::inline v0::lockstep
