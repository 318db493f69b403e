// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/ld06_wire.hpp"

#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"

namespace picolo::inline v0::sim {

std::array<std::uint8_t, kLd06PacketSize> encode(const Ld06Packet& packet) {
  std::array<std::uint8_t, kLd06PacketSize> bytes{};
  bytes[0] = 0x54;
  bytes[1] = 0x2C;
  store_u16_le(bytes, 2, packet.speed_dps);
  store_u16_le(bytes, 4, packet.start_cdeg);
  for (std::size_t i = 0; i < kLd06Points; ++i) {
    store_u16_le(bytes, 6 + 3 * i, packet.range_mm[i]);
    bytes[8 + 3 * i] = packet.intensity[i];
  }
  store_u16_le(bytes, 42, packet.end_cdeg);
  store_u16_le(bytes, 44, packet.stamp_ms);
  bytes[46] = crc8(std::span<const std::uint8_t>{bytes}.first(46), 0x4D);
  return bytes;
}

}  // namespace picolo::inline v0::sim
