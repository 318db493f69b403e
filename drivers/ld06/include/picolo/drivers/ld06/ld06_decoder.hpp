// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// LD06 bytes to packets, packets to readings. Pure: no I/O, no clock. Any number of instances.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/common/framer.hpp"
#include "picolo/drivers/common/turn_cutter.hpp"
#include "picolo/drivers/ld06/ld06_packet.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

/// Incremental: the same packets come out however the stream is cut into pieces.
class Ld06Decoder {
 public:
  explicit Ld06Decoder(const Ld06Format& format = {}) : framer_(format) {}

  /// Takes one byte. `ok`: it completed `packet()`. `not_ready`: it did not. Cost: O(1), after
  /// damage O(packet).
  Status push(std::uint8_t byte);
  [[nodiscard]] const Ld06Packet& packet() const { return packet_; }
  /// Bytes of the packet that is on its way: at most (pending + n) / 47 packets complete within the
  /// next n bytes.
  [[nodiscard]] std::size_t pending() const { return framer_.pending(); }
  /// Forgets what waits: the line was interrupted.
  void reset() { framer_.reset(); }
  [[nodiscard]] const FramerCounters& counters() const { return framer_.counters(); }

 private:
  Framer<Ld06Format> framer_;
  Ld06Packet packet_{};
};

struct Ld06ReadingConfig {
  /// Readings weaker than this and farther than `weak_beyond_mm` become range 0: noise in glare. 0
  /// = keep all.
  std::uint8_t min_intensity = 0;
  std::uint16_t weak_beyond_mm = 0;
};

/// Polar coordinates and the border between revolutions.
/// A revolution starts where the device's angle passes from 360 to 0 degrees, at most once in half
/// a turn.
class Ld06Readings {
 public:
  explicit Ld06Readings(const Ld06ReadingConfig& config = {}) : config_(config) {}

  /// Writes range, bearing and `starts_sweep` of the 12 points; stamps are left alone. Call with
  /// every packet, in order.
  void convert(const Ld06Packet& packet, std::span<RangeReading, kLd06PointsPerPacket> readings);

 private:
  Ld06ReadingConfig config_;
  /// In 1/11 of 0.01 degrees, so that every point is a whole number.
  TurnCutter cutter_{kLd06FullTurnCdeg * (kLd06PointsPerPacket - 1)};
};

}  // namespace picolo::inline v0
