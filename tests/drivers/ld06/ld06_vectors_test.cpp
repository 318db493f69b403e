// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ld06_wire.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "support/fake_serial_port.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

/// What the shell makes of the pieces, in order.
std::vector<RangeReading> read_all(const std::vector<Bytes>& pieces) {
  FakeSerialPort port{250'000};  // 40 us a byte: no rounding
  Timestamp stamp{1s};
  for (const Bytes& piece : pieces) {
    stamp += transmission_time(piece.size(), port.baud());
    port.arrives(stamp, piece);
  }
  Ld06 lidar{port};
  std::vector<RangeReading> all;
  std::array<RangeReading, 24> readings{};
  for (auto count = lidar.poll(1000, readings); count; count = lidar.poll(1000, readings)) {
    all.insert(all.end(), readings.begin(), readings.begin() + static_cast<std::ptrdiff_t>(*count));
  }
  return all;
}

bool equal(const std::vector<RangeReading>& a, const std::vector<RangeReading>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const RangeReading& x, const RangeReading& y) {
                      return x.stamp == y.stamp && x.range_m == y.range_m &&
                             x.bearing_rad == y.bearing_rad && x.starts_sweep == y.starts_sweep;
                    });
}

TEST(Ld06Vectors, GivenRecordedPacketsThenFieldsAndReadingsAreAsPublished) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("LD06/LD19");
  ASSERT_GE(vectors.size(), 2U);
  for (const ByteVector& vector : vectors) {
    SCOPED_TRACE(vector.id);
    Ld06Decoder decoder;
    int packets = 0;
    for (const std::uint8_t byte : vector.bytes) { packets += is_ok(decoder.push(byte)) ? 1 : 0; }
    ASSERT_EQ(packets, 1);
    const Ld06Packet& packet = decoder.packet();
    EXPECT_EQ(packet.speed_degps, vector.expected.at("speed_deg_s").get<int>());
    EXPECT_EQ(packet.start_cdeg,
              std::lround(vector.expected.at("start_angle_deg").get<double>() * 100));
    EXPECT_EQ(packet.end_cdeg,
              std::lround(vector.expected.at("end_angle_deg").get<double>() * 100));
    EXPECT_EQ(packet.timestamp_ms, vector.expected.at("timestamp_ms").get<int>());

    const auto readings = read_all({vector.bytes});
    const auto& points = vector.expected.at("points");
    ASSERT_EQ(readings.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(packet.points.at(i).distance_mm, points[i].at("distance_mm").get<int>());
      EXPECT_EQ(packet.points.at(i).intensity, points[i].at("intensity").get<int>());
      EXPECT_FLOAT_EQ(readings[i].range_m, points[i].at("distance_mm").get<float>() / 1000.0F);
      const double bearing_deg =
          static_cast<double>(readings[i].bearing_rad) * 180.0 / std::numbers::pi;
      EXPECT_NEAR(std::remainder(bearing_deg + points[i].at("angle_deg").get<double>(), 360.0), 0.0,
                  1e-4);
    }
  }
}

TEST(Ld06Vectors, GivenAnyCutOfTheStreamThenTheReadingsAreTheSame) {
  PICOLO_NEED_DATA(kVectorFile);
  Bytes stream;
  for (const ByteVector& vector : byte_vectors("LD06/LD19")) {
    stream = join({stream, vector.bytes, {0x54, 0x00}});
  }
  for (unsigned i = 0; i < 100; ++i) { stream = join({stream, wire_bytes(spinning_packet(i))}); }
  const auto whole = read_all({stream});
  ASSERT_EQ(whole.size(), 102U * 12U);
  std::vector<Bytes> single;
  for (const std::uint8_t byte : stream) { single.push_back({byte}); }
  EXPECT_TRUE(equal(read_all(single), whole));
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    EXPECT_TRUE(equal(read_all(cut_randomly(stream, 1 + seed * 5, seed)), whole))
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace picolo::test
