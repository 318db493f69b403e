// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06_packet.hpp"

#include <array>

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kHeader = 0x54;
constexpr std::uint8_t kVersionAndLength = 0x2C;
constexpr std::size_t kPointsOffset = 6;

/// CRC-8, polynomial 0x4D, most significant bit first, start 0. By table: bit by bit it was most of
/// the decoder's work.
constexpr std::array<std::uint8_t, 256> make_crc_table() {
  std::array<std::uint8_t, 256> table{};
  for (std::uint32_t value = 0; value < table.size(); ++value) {
    std::uint32_t crc = value;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x80U) != 0 ? ((crc << 1) ^ 0x4DU) & 0xFFU : crc << 1;
    }
    table[value] = static_cast<std::uint8_t>(crc);
  }
  return table;
}
constexpr std::array<std::uint8_t, 256> kCrcTable = make_crc_table();
static_assert(kCrcTable[1] == 0x4D && kCrcTable[2] == 0x9A && kCrcTable[3] == 0xD7 &&
              kCrcTable[4] == 0x79);

std::uint8_t crc_of(ByteView bytes) {
  std::uint8_t crc = 0;
  for (const std::uint8_t byte : bytes) { crc = kCrcTable[crc ^ byte]; }
  return crc;
}

bool plausible(const Ld06Packet& packet, std::uint32_t min_points_per_second) {
  if (packet.start_cdeg > kLd06FullTurnCdeg || packet.end_cdeg > kLd06FullTurnCdeg) {
    return false;
  }
  // span <= 1.5 * speed * points / rate, in whole numbers
  constexpr std::uint32_t kSpeedFactor = 100 * kLd06PointsPerPacket * 3 / 2;
  return span_cdeg(packet) * min_points_per_second <= packet.speed_degps * kSpeedFactor;
}

}  // namespace

Ld06Packet parse_ld06(ByteView bytes) {
  Ld06Packet packet{.speed_degps = load_u16_le(bytes, 2),
                    .start_cdeg = load_u16_le(bytes, 4),
                    .end_cdeg = load_u16_le(bytes, 42),
                    .timestamp_ms = load_u16_le(bytes, 44)};
  for (std::size_t i = 0; i < kLd06PointsPerPacket; ++i) {
    packet.points[i] = {load_u16_le(bytes, kPointsOffset + 3 * i),
                        bytes[kPointsOffset + 3 * i + 2]};
  }
  return packet;
}

FrameCheck Ld06Format::check(ByteView bytes) const {
  if (bytes[0] != kHeader) { return {FrameVerdict::no_header}; }
  if (bytes.size() > 1 && bytes[1] != kVersionAndLength) { return {FrameVerdict::no_header}; }
  if (bytes.size() < kLd06PacketSize) { return {FrameVerdict::incomplete}; }
  if (crc_of(bytes.first(kLd06PacketSize - 1)) != bytes[kLd06PacketSize - 1]) {
    return {FrameVerdict::checksum};
  }
  if (!plausible(parse_ld06(bytes), min_points_per_second)) { return {FrameVerdict::implausible}; }
  return {FrameVerdict::complete, kLd06PacketSize};
}

}  // namespace picolo::inline v0
