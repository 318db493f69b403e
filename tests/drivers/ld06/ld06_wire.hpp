// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// An LD06 as the tests imagine it: written from the manual, independent of the decoder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "picolo/drivers/ld06/ld06_packet.hpp"
#include "support/bytes.hpp"

namespace picolo::test {

/// The manual's CRC by table, the table by long division of the byte's polynomial.
inline std::uint8_t wire_crc(const Bytes& bytes) {
  std::array<std::uint8_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    unsigned remainder = i << 8;
    for (unsigned bit = 15; bit >= 8; --bit) {
      if (((remainder >> bit) & 1U) != 0) { remainder ^= 0x14DU << (bit - 8); }
    }
    table.at(i) = static_cast<std::uint8_t>(remainder);
  }
  std::uint8_t crc = 0;
  for (const std::uint8_t byte : bytes) { crc = table.at(crc ^ byte); }
  return crc;
}

inline void append_u16(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

inline Bytes wire_bytes(const Ld06Packet& packet) {
  Bytes bytes{0x54, 0x2C};
  append_u16(bytes, packet.speed_degps);
  append_u16(bytes, packet.start_cdeg);
  for (const Ld06Point& point : packet.points) {
    append_u16(bytes, point.distance_mm);
    bytes.push_back(point.intensity);
  }
  append_u16(bytes, packet.end_cdeg);
  append_u16(bytes, packet.timestamp_ms);
  bytes.push_back(wire_crc(bytes));
  return bytes;
}

/// Packet `index` of a lidar that turns at 10 Hz and measures 4500 points a second: 0.8 degrees
/// from point to point. All distances are `distance_mm + point`.
inline Ld06Packet spinning_packet(unsigned index, std::uint16_t distance_mm = 1000) {
  Ld06Packet packet{.speed_degps = 3600,
                    .start_cdeg = static_cast<std::uint16_t>(index * 960 % 36000),
                    .end_cdeg = static_cast<std::uint16_t>((index * 960 + 880) % 36000),
                    .timestamp_ms = static_cast<std::uint16_t>(index * 8 / 3 % 30000)};
  for (std::size_t i = 0; i < packet.points.size(); ++i) {
    packet.points.at(i) = {static_cast<std::uint16_t>(distance_mm + i),
                           static_cast<std::uint8_t>(200 + i)};
  }
  return packet;
}

inline bool equal(const Ld06Packet& a, const Ld06Packet& b) {
  return wire_bytes(a) == wire_bytes(b);
}

}  // namespace picolo::test
