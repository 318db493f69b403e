// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Express (0x82) and dense (0x85) capsules, of which no recording is at hand: one of each packed by
// hand from the vendor's structures, and whole turns packed here bit by bit, in degrees and
// millimetres, by the formulas of the vendor's protocol document (LR001):
//   angle of node k = start + (next start - start) k / nodes - offset of k (express only).

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "picolo/drivers/rplidar/rplidar_capsule.hpp"
#include "support/bytes.hpp"

namespace picolo::test {
namespace {

std::vector<RplidarNode> decode(const Bytes& stream, RplidarMode mode) {
  RplidarCapsules capsules{mode};
  std::array<RplidarNode, kRplidarMaxNodes> nodes{};
  std::vector<RplidarNode> all;
  for (const std::uint8_t byte : stream) {
    const std::size_t count = capsules.push(byte, nodes);
    all.insert(all.end(), nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

/// Header, cabins from their beginning, zeros behind.
Bytes by_hand(const char* header, const char* cabins) {
  Bytes bytes = join({from_hex(header), from_hex(cabins)});
  bytes.resize(84);
  return bytes;
}

void expect_node(const RplidarNode& node, unsigned angle_z_q14, unsigned dist_mm_q2, unsigned flag,
                 const char* which) {
  EXPECT_EQ(node.angle_z_q14, angle_z_q14) << which;
  EXPECT_EQ(node.dist_mm_q2, dist_mm_q2) << which;
  EXPECT_EQ(node.quality, dist_mm_q2 == 0 ? 0U : 0x2FU << 2U) << which;
  EXPECT_EQ(node.flag, flag) << which;
}

// Start 340 degrees (21760 / 64), first after the start command; the next at 8.8 (563 / 64).
// Cabin: 1234 mm with 60/8 degrees, 5678 mm with 5/8:
//   word 1 = 1234 << 2 | 60 >> 4, word 2 = 5678 << 2 | 0, last byte = (60 & 15) | 5 << 4.
TEST(RplidarCapsules, GivenAnExpressCapsulePackedByHandThenItsNodesAreThoseOfTheVendorsFormula) {
  const Bytes first = by_hand("A1 53 00 D5", "4B 13 B8 58 5C");
  const Bytes next = by_hand("A1 53 33 02", "");
  const auto nodes = decode(join({first, next, from_hex("A050")}), RplidarMode::express);
  ASSERT_EQ(nodes.size(), 32U);
  // 340 - 7.5 = 332.5 degrees; 340 + 28.796875 / 32 - 0.625 = 340.27: 21777 / 64.
  expect_node(nodes[0], 21280 * 256 / 90, 4 * 1234, 2, "first");
  expect_node(nodes[1], 21777 * 256 / 90, 4 * 5678, 2, "second");
  expect_node(nodes[2], 21875 * 256 / 90, 0, 2, "third, nothing measured");
  // Node 22 stands at 359.798, node 23 behind the turn at 0.698: the scan begins with 22.
  expect_node(nodes[22], 23027 * 256 / 90, 0, 1, "last before 360 degrees");
  expect_node(nodes[23], 44 * 256 / 90, 0, 2, "first behind");
}

TEST(RplidarCapsules, GivenADenseCapsulePackedByHandThenItsDistancesAreMillimetres) {
  const Bytes first = by_hand("AF 53 00 D5", "E8 03 FF FF 01 00");
  const Bytes next = by_hand("A1 53 33 02", "");
  const auto nodes = decode(join({first, next, from_hex("A050")}), RplidarMode::dense);
  ASSERT_EQ(nodes.size(), 40U);
  expect_node(nodes[0], 21760 * 256 / 90, 4 * 1000, 2, "first");
  expect_node(nodes[1], 21806 * 256 / 90, 4 * 65535, 2, "second: 0.71992 degrees on");
  expect_node(nodes[2], 21852 * 256 / 90, 4, 2, "third");
  expect_node(nodes[27], 23004 * 256 / 90, 0, 1, "last before 360 degrees");
  expect_node(nodes[28], 10 * 256 / 90, 0, 2, "first behind");
}

/// One capsule; `beam(k)` says what node k measures: millimetres, and eighths of a degree.
struct Beam {
  unsigned mm = 0;
  unsigned offset_q3 = 0;
};
Bytes packed(double start_deg, bool scan_starts, std::size_t nodes,
             const std::function<Beam(std::size_t)>& beam) {
  std::array<bool, 84 * 8> bits{};
  auto put = [&bits](std::size_t byte, std::size_t bit, std::size_t width, unsigned value) {
    for (std::size_t i = 0; i < width; ++i) { bits[8 * byte + bit + i] = (value >> i & 1U) != 0; }
  };
  put(2, 0, 15, static_cast<unsigned>(std::lround(start_deg * 64)));
  put(3, 7, 1, scan_starts ? 1 : 0);
  for (std::size_t k = 0; k < nodes; ++k) {
    const Beam node = beam(k);
    if (nodes == 40) {
      put(4 + 2 * k, 0, 16, node.mm);
      continue;
    }
    const std::size_t cabin = 4 + 5 * (k / 2);
    put(cabin + 2 * (k % 2), 0, 2, node.offset_q3 >> 4U);
    put(cabin + 2 * (k % 2), 2, 14, node.mm);
    put(cabin + 4, 4 * (k % 2), 4, node.offset_q3 & 15U);
  }
  Bytes bytes(84);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | (bits[i] ? 1U << (i % 8) : 0U));
  }
  unsigned sum = 0;
  for (std::size_t i = 2; i < bytes.size(); ++i) { sum ^= bytes[i]; }
  bytes[0] = static_cast<std::uint8_t>(0xA0U + sum % 16);
  bytes[1] = static_cast<std::uint8_t>(0x50U + sum / 16);
  return bytes;
}

TEST(RplidarCapsules, GivenTurnsAtAnUnevenSpeedThenEveryNodeStandsWhereItWasMeasured) {
  for (const std::size_t size : {32U, 40U}) {
    const RplidarMode mode = size == 32 ? RplidarMode::express : RplidarMode::dense;
    const unsigned farthest = size == 32 ? 16'383 : 65'535;
    auto beam_of = [&](std::size_t number) {
      return Beam{.mm = static_cast<unsigned>(number * 7919) % (farthest + 1),
                  .offset_q3 = size == 32 ? static_cast<unsigned>(number * 37) % 64 : 0U};
    };
    Bytes stream;
    std::vector<double> starts_deg;
    double start_deg = 300.0;
    for (std::size_t i = 0; i < 60; ++i) {
      starts_deg.push_back(start_deg);
      stream = join({stream, packed(std::fmod(start_deg, 360.0), i == 0, size,
                                    [&](std::size_t k) { return beam_of(i * size + k); })});
      start_deg += (1600 + 40 * static_cast<double>(i % 11)) / 64;  // 25 to 31 degrees
    }
    const auto nodes = decode(stream, mode);
    ASSERT_EQ(nodes.size(), 59 * size);
    std::vector<std::size_t> scan_starts;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const double from = starts_deg[n / size];
      const double part = static_cast<double>(n % size) / static_cast<double>(size);
      const double even_deg = from + (starts_deg[n / size + 1] - from) * part;
      const Beam beam = beam_of(n);
      const double measured_deg = nodes[n].angle_z_q14 * 90.0 / 16384.0;
      const double beside = measured_deg - (even_deg - beam.offset_q3 / 8.0);
      ASSERT_NEAR(std::remainder(beside, 360.0), 0.0, 0.0225) << size << ", node " << n;
      ASSERT_EQ(nodes[n].dist_mm_q2, 4 * beam.mm) << size << ", node " << n;
      if ((nodes[n].flag & 1U) == 0) { continue; }
      scan_starts.push_back(n);
      EXPECT_GT(std::fmod(even_deg, 360.0), 358.9) << size << ", node " << n;
    }
    EXPECT_EQ(scan_starts.size(), 5U) << size;
  }
}

TEST(RplidarCapsules, GivenTheBitOfANewScanThenNothingIsLaidOutAcrossIt) {
  auto far = [](std::size_t) { return Beam{.mm = 2000}; };
  Bytes stream;
  for (const double start_deg : {10.0, 38.0, 20.0, 48.0}) {
    stream = join({stream, packed(start_deg, start_deg == 20.0, 40, far)});
  }
  EXPECT_EQ(decode(stream, RplidarMode::dense).size(), 80U);
}

}  // namespace
}  // namespace picolo::test
