// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/ydlidar/ydlidar.hpp"
#include "support/bytes.hpp"
#include "support/fake_serial_port.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

Bytes packet(double first_deg, double last_deg, const std::vector<std::uint16_t>& distances_mm,
             std::size_t width) {
  Bytes bytes(10 + distances_mm.size() * width);
  bytes[0] = 0xAA;
  bytes[1] = 0x55;
  bytes[3] = static_cast<std::uint8_t>(distances_mm.size());
  auto angle = [](double deg) {
    return static_cast<std::uint16_t>((std::lround(deg * 64) << 1) | 1);
  };
  store_u16_le(bytes, 4, angle(first_deg));
  store_u16_le(bytes, 6, angle(last_deg));
  unsigned sum =
      load_u16_le(bytes, 0) ^ load_u16_le(bytes, 2) ^ load_u16_le(bytes, 4) ^ load_u16_le(bytes, 6);
  for (std::size_t i = 0; i < distances_mm.size(); ++i) {
    std::size_t at = 10 + i * width;
    if (width == 3) {
      bytes[at] = static_cast<std::uint8_t>(50 + i);
      sum ^= bytes[at];
      ++at;
    }
    store_u16_le(bytes, at, static_cast<std::uint16_t>(distances_mm[i] << 2U));
    sum ^= load_u16_le(bytes, at);
  }
  store_u16_le(bytes, 8, static_cast<std::uint16_t>(sum));
  return bytes;
}

std::vector<RangeReading> read_all(const std::vector<Bytes>& pieces, const YdlidarConfig& config) {
  FakeSerialPort port{250'000};
  Timestamp stamp{10s};
  for (const Bytes& piece : pieces) {
    stamp += transmission_time(piece.size(), port.baud());
    port.arrives(stamp, piece);
  }
  Ydlidar lidar{port, config};
  std::vector<RangeReading> all;
  std::array<RangeReading, 48> readings{};
  for (auto count = lidar.poll(4096, readings); count; count = lidar.poll(4096, readings)) {
    all.insert(all.end(), readings.begin(), readings.begin() + static_cast<std::ptrdiff_t>(*count));
  }
  return all;
}

TEST(Ydlidar, GivenARecordedPacketThenEverySampleIsAsPublished) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("YDLIDAR AA55 3-byte (intensity)");
  ASSERT_EQ(vectors.size(), 1U);
  YdlidarProtocol protocol{{.optics = YdlidarOptics::aligned, .active = false}};
  std::vector<RangeReading> readings(YdlidarProtocol::kMaxSamplesPerByte);
  std::size_t count = 0;
  for (const std::uint8_t byte : vectors[0].bytes) { count += protocol.push(byte, {}, readings); }
  const auto& expected = vectors[0].expected;
  ASSERT_EQ(count, expected.at("count").get<std::size_t>());
  EXPECT_EQ(protocol.sample_bytes(), 3U);
  EXPECT_EQ(protocol.header().starts_scan, expected.at("start_packet").get<bool>());
  for (std::size_t i = 0; i < count; ++i) {
    SCOPED_TRACE(i);
    const auto& point = expected.at("points").at(i);
    EXPECT_EQ(protocol.points()[i].distance_mm, point.at("distance_mm").get<unsigned>());
    EXPECT_EQ(protocol.points()[i].intensity, point.at("intensity").get<unsigned>());
    EXPECT_EQ(protocol.points()[i].flags, point.at("flag").get<unsigned>());
    const double bearing_deg =
        static_cast<double>(readings[i].bearing_rad) * 180 / std::numbers::pi;
    EXPECT_NEAR(std::remainder(bearing_deg + point.at("angle_deg").get<double>(), 360.0), 0.0,
                0.5 / 64 + 1.0 / 64);
  }
}

TEST(Ydlidar, GivenEitherWidthThenItIsFoundWithoutLosingAPacket) {
  for (const std::size_t width : {2U, 3U}) {
    std::vector<Bytes> stream;
    for (int i = 0; i < 9; ++i) {
      stream.push_back(
          packet(40.0 * i, 40.0 * i + 36.0, std::vector<std::uint16_t>(40, 1000), width));
    }
    EXPECT_EQ(read_all(stream, {.active = false}).size(), 360U) << width;
  }
}

TEST(Ydlidar, GivenNearThingsThenTheBearingFollowsTheOptics) {
  const auto readings =
      read_all({packet(90.0, 90.0, {200}, 2), packet(90.0, 90.0, {0}, 2)}, {.active = false});
  ASSERT_EQ(readings.size(), 2U);
  const double correction = std::atan(21.8 * (155.3 - 200) / (155.3 * 200));
  EXPECT_NEAR(readings[0].bearing_rad, -std::numbers::pi / 2 - correction, 1e-5);
  EXPECT_NEAR(readings[1].bearing_rad, -std::numbers::pi / 2, 1e-5);
}

TEST(Ydlidar, GivenTurnsThenEachStartsOnceWhereTheAnglePassesZero) {
  std::vector<Bytes> stream;
  for (int turn = 0; turn < 3; ++turn) {
    stream.push_back(packet(359.9, 359.9, {900}, 2));  // the zero packet
    for (int i = 0; i < 9; ++i) {
      stream.push_back(
          packet(40.0 * i + 0.1, 40.0 * i + 39.0, std::vector<std::uint16_t>(40, 900), 2));
    }
  }
  int starts = 0;
  for (const RangeReading& reading : read_all(stream, {.active = false})) {
    starts += reading.starts_sweep ? 1 : 0;
  }
  EXPECT_EQ(starts, 3);
}

TEST(Ydlidar, GivenADamagedLengthThenTheNextPacketIsNotHeldBack) {
  YdlidarProtocol protocol{{.active = false}};
  std::vector<RangeReading> readings(YdlidarProtocol::kMaxSamplesPerByte);
  const Bytes good = packet(10.0, 40.0, std::vector<std::uint16_t>(40, 1000), 2);
  Bytes damaged = good;
  damaged[3] = 104;
  std::size_t count = 0;
  for (const std::uint8_t byte : join({good, damaged, good})) {
    count += protocol.push(byte, {}, readings);
  }
  EXPECT_EQ(count, 80U);
}

}  // namespace
}  // namespace picolo::test
