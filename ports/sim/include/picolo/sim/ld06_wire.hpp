// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The packet of the LD06/LD19 lidar as it goes over the wire, from the vendor's manual: 47 bytes,
/// little-endian, 54 2C | speed deg/s | start 0.01 deg | 12 x (mm, intensity) | end 0.01 deg | ms
/// 0..29999 | CRC-8 0x4D.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace picolo::inline v0::sim {

inline constexpr std::size_t kLd06Points = 12;
inline constexpr std::size_t kLd06PacketSize = 47;
inline constexpr std::uint32_t kLd06Baud = 230'400;

struct Ld06Packet {
  std::uint16_t speed_dps = 3600;  ///< rotation, degrees per second
  std::uint16_t start_cdeg = 0;    ///< 0..35999, clockwise seen from above, of the first point
  std::uint16_t end_cdeg = 0;      ///< of the last point; the others lie evenly between
  std::array<std::uint16_t, kLd06Points> range_mm{};  ///< 0: nothing came back
  std::array<std::uint8_t, kLd06Points> intensity{};
  std::uint16_t stamp_ms = 0;  ///< device time of the last point, 0..29999
};

[[nodiscard]] std::array<std::uint8_t, kLd06PacketSize> encode(const Ld06Packet& packet);

}  // namespace picolo::inline v0::sim
