// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The packet of LDROBOT LD06, LD19, STL-19P and their kin: 47 bytes, 12 points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kLd06PointsPerPacket = 12;
inline constexpr std::size_t kLd06PacketSize = 47;
inline constexpr std::uint32_t kLd06FullTurnCdeg = 36000;
inline constexpr std::uint32_t kLd06TimestampWrapMs = 30000;

struct Ld06Point {
  std::uint16_t distance_mm = 0;  ///< 0 = nothing measured, whatever the intensity
  std::uint8_t intensity = 0;
};

/// As on the wire: hundredths of a degree, clockwise seen from above.
struct Ld06Packet {
  std::uint16_t speed_degps = 0;
  std::uint16_t start_cdeg = 0;    ///< of the first point
  std::uint16_t end_cdeg = 0;      ///< of the last point
  std::uint16_t timestamp_ms = 0;  ///< device clock, 0 to 29999, then again 0
  std::array<Ld06Point, kLd06PointsPerPacket> points{};
};

/// Angle from first to last point, in [0, 36000).
[[nodiscard]] constexpr std::uint32_t span_cdeg(const Ld06Packet& packet) {
  return (packet.end_cdeg + kLd06FullTurnCdeg - packet.start_cdeg % kLd06FullTurnCdeg) %
         kLd06FullTurnCdeg;
}

/// Precondition: bytes.size() >= kLd06PacketSize; the checksum was tested.
[[nodiscard]] Ld06Packet parse_ld06(ByteView bytes);

/// Header, CRC-8 with polynomial 0x4D, and whether the angles fit the speed.
struct Ld06Format {
  static constexpr std::size_t kMaxFrame = kLd06PacketSize;
  /// Slowest sampling that is believed: a packet spans at most 1.5 * speed * 12 / this. The example
  /// of the manual was taken at about 2300 points a second; current firmware measures 4500.
  std::uint32_t min_points_per_second = 2300;

  [[nodiscard]] FrameCheck check(ByteView bytes) const;
};

}  // namespace picolo::inline v0
