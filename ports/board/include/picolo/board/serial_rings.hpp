// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two rings between the interrupts of one UART and the cycle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/ring_buffer.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0::board {

/// Every byte is stamped in its interrupt, to the microsecond; a byte must be read within 16 s of
/// its arrival. Memory: 4.6 KiB.
class SerialRings {
 public:
  static constexpr std::uint32_t kReceive = 1024;  ///< 44 ms at 230400 baud
  static constexpr std::uint32_t kSend = 512;

  // From the UART's interrupts; none of them interrupts another.
  void received(std::uint8_t byte, Timestamp now);
  /// The hardware lost a byte.
  void overrun();
  /// False: nothing is left to send.
  [[nodiscard]] bool next_to_send(std::uint8_t& byte) { return to_send_.pop(byte); }

  // From the cycle; as in SerialPort.
  Result<SerialRead> read(std::span<std::uint8_t> buffer, Clock& clock);
  /// `full`: none was taken.
  Result<std::size_t> write(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::uint32_t lost() const { return received_.dropped() + overruns_; }
  /// Bytes received, those that did not fit included; modulo 2^32.
  [[nodiscard]] std::uint32_t arrived() const { return arrived_; }

 private:
  static constexpr std::uint32_t kStampMask = 0xFF'FFFF;

  SpscRing<std::uint32_t, kReceive> received_{};  // low 24 bits of the stamp, then the byte
  SpscRing<std::uint8_t, kSend> to_send_{};
  // One writer each, one word each: never seen torn.
  volatile std::uint32_t arrived_ = 0;
  volatile std::uint32_t overruns_ = 0;
};

}  // namespace picolo::inline v0::board
