// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// LD06, LD19 and STL-19P lidars on a serial line (230400 baud, 8N1, they talk without being
/// asked).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/drivers/ld06/ld06_timeline.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

struct Ld06Config {
  Ld06Format format{};
  Ld06ReadingConfig readings{};
  Ld06TimelineConfig timeline{};
  [[nodiscard]] constexpr bool valid() const {
    return format.min_points_per_second > 0 && timeline.valid();
  }
};

/// Never reset.
struct Ld06Counters {
  std::uint32_t bytes = 0;
  std::uint32_t packets = 0;
  std::uint32_t bad_checksums = 0;
  std::uint32_t implausible = 0;     ///< right checksum, impossible angles
  std::uint32_t skipped_bytes = 0;   ///< bytes that were part of no packet
  std::uint32_t clock_restarts = 0;  ///< the device's clock did not fit ours any more
};

/// Polling shell. Precondition: config.valid(). Context: one at a time. Memory: about 300 bytes, no
/// heap.
class Ld06 {
 public:
  explicit Ld06(SerialPort& port, const Ld06Config& config = {});

  /// Reads at most `max_bytes` and writes the readings of all packets that they complete; returns
  /// how many. Reads no more bytes than `readings` has room for, so none is lost. Stamps never
  /// decrease, across calls too. `not_ready`: no packet complete yet. `invalid_argument`: room for
  /// less than one packet (12). `disconnected` and the like: from the port, after everything read
  /// before was handed out. Cost: O(max_bytes).
  [[nodiscard]] Result<std::size_t> poll(std::size_t max_bytes, std::span<RangeReading> readings);

  /// Speed of the last packet in degrees per second; 0 before the first.
  [[nodiscard]] std::uint16_t speed_degps() const { return decoder_.packet().speed_degps; }
  /// When the last packet's last point was measured.
  [[nodiscard]] Timestamp last_stamp() const { return timeline_.last_stamp(); }
  [[nodiscard]] Ld06Counters counters() const;

 private:
  SerialPort& port_;
  Ld06Decoder decoder_;
  Ld06Readings readings_;
  Ld06Timeline timeline_;
  std::uint32_t bytes_ = 0;
};

}  // namespace picolo::inline v0
