// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// RPLIDAR capsules: the number is in the distances, and in the start angle.
#include <array>
#include <cmath>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/drivers/rplidar/rplidar_capsule.hpp"
#include "wires.hpp"

namespace picolo::test {
namespace {

constexpr std::uint32_t kCapsuleDeg = 36;

Bytes sealed(Bytes capsule, std::uint32_t number) {
  store_u16_le(capsule, 2, static_cast<std::uint16_t>(number * kCapsuleDeg * 64 % (360 * 64)));
  const std::uint8_t sum = xor8(std::span<const std::uint8_t>{capsule}.subspan(2));
  capsule[0] = static_cast<std::uint8_t>(0xA0U | (sum & 0xFU));
  capsule[1] = static_cast<std::uint8_t>(0x50U | (sum >> 4U));
  return capsule;
}

/// Feeds a stream; `dist_mm(number, node)` is what each node must say, and `offset_deg` how far its
/// beam may look beside the even angle.
template <typename Distance>
std::vector<Accepted> capsules_read(const Bytes& stream, RplidarMode mode, std::size_t size,
                                    std::uint32_t base_mm, std::uint32_t step_mm, double offset_deg,
                                    const Distance& dist_mm) {
  std::vector<Accepted> all;
  RplidarCapsules decoder{mode};
  std::array<RplidarNode, kRplidarMaxNodes> nodes{};
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const std::size_t count = decoder.push(stream[i], nodes);
    if (count == 0) { continue; }
    const std::uint32_t number = (nodes[0].dist_mm_q2 / 4 - base_mm) / step_mm;
    bool intact = count == size;
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = static_cast<double>(nodes[k].angle_z_q14) * 90.0 / 16384.0;
      const double expected =
          number * kCapsuleDeg + static_cast<double>(k) * kCapsuleDeg / static_cast<double>(size);
      const double beside = std::remainder(angle - expected, 360.0);
      // The last node of an ultra capsule is told by its successor, which may be lost.
      const bool unknown = mode == RplidarMode::ultra && k + 1 == size && nodes[k].dist_mm_q2 == 0;
      intact = intact && (unknown || nodes[k].dist_mm_q2 == 4 * dist_mm(number, k)) &&
               std::abs(beside) < 0.1 + offset_deg;
    }
    all.push_back({number, i + 1, intact});
  }
  return all;
}

std::uint32_t dense_mm(std::uint32_t number, std::size_t node) {
  return 1000 + 40 * number + static_cast<std::uint32_t>(node);
}

Bytes dense_packet(std::uint32_t number) {
  Bytes bytes(84);
  for (std::size_t i = 0; i < 40; ++i) {
    store_u16_le(bytes, 4 + 2 * i, static_cast<std::uint16_t>(dense_mm(number, i)));
  }
  return sealed(bytes, number);
}

std::vector<Accepted> dense_read(const Bytes& stream) {
  return capsules_read(stream, RplidarMode::dense, 40, 1000, 40, 0.0, dense_mm);
}

std::uint32_t express_mm(std::uint32_t number, std::size_t node) {
  return 1000 + 32 * number + static_cast<std::uint32_t>(node);
}

Bytes express_packet(std::uint32_t number) {
  Bytes bytes(84);
  for (std::size_t i = 0; i < 32; ++i) {
    store_u16_le(bytes, 4 + 5 * (i / 2) + 2 * (i % 2),
                 static_cast<std::uint16_t>(4 * express_mm(number, i)));
  }
  return sealed(bytes, number);
}

std::vector<Accepted> express_read(const Bytes& stream) {
  return capsules_read(stream, RplidarMode::express, 32, 1000, 32, 0.0, express_mm);
}

std::uint32_t ultra_major(std::uint32_t number, std::size_t cabin) {
  const auto c = static_cast<std::uint32_t>(cabin % 32);
  return 100 + number + (cabin < 32 ? c * 13 % 200 : 1);  // 32: the first of the successor
}

/// Three nodes a cabin: the major, and two predicted from it and from the next major.
std::uint32_t ultra_mm(std::uint32_t number, std::size_t node) {
  const std::size_t cabin = node / 3;
  const auto c = static_cast<std::uint32_t>(cabin);
  if (node % 3 == 0) { return ultra_major(number, cabin); }
  if (node % 3 == 1) { return ultra_major(number, cabin) + c % 16; }
  return ultra_major(number, cabin + 1) - 1 - c % 8;
}

Bytes ultra_packet(std::uint32_t number) {
  Bytes bytes(132);
  for (std::size_t i = 0; i < 32; ++i) {
    const auto c = static_cast<std::uint32_t>(i);
    const std::uint32_t word =
        ultra_major(number, i) | ((c % 16) << 12U) | ((0x3FFU - c % 8) << 22U);
    for (unsigned k = 0; k < 4; ++k) {
      bytes[4 + 4 * i + k] = static_cast<std::uint8_t>(word >> (8 * k));
    }
  }
  return sealed(bytes, number);
}

std::vector<Accepted> ultra_read(const Bytes& stream) {
  return capsules_read(stream, RplidarMode::ultra, 96, 100, 1, 9.0, ultra_mm);
}

}  // namespace

std::vector<Wire> capsule_wires() {
  return {
      {"rplidar 0x82", express_packet, express_read, 8 + 8, 84, 40},
      {"rplidar 0x84", ultra_packet, ultra_read, 8 + 8, 132},
      {"rplidar 0x85", dense_packet, dense_read, 8 + 8, 84, 40},
  };
}

}  // namespace picolo::test
