// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// The conversation with an RPLIDAR, and what damage does to its standard nodes.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "picolo/core/crc.hpp"
#include "picolo/drivers/rplidar/rplidar.hpp"
#include "support/bytes.hpp"
#include "support/fake_serial_port.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

Bytes node_bytes(std::uint32_t index, std::uint32_t nodes_per_turn = 320) {
  const std::uint32_t in_turn = index % nodes_per_turn;
  const std::uint32_t angle_q6 = in_turn * 360 * 64 / nodes_per_turn;
  const std::uint32_t dist_q2 = 4 * (1000 + index % 997);
  const unsigned start = in_turn == 0 ? 1 : 2;
  return {static_cast<std::uint8_t>((15U << 2U) | start),
          static_cast<std::uint8_t>(((angle_q6 & 0x7FU) << 1U) | 1U),
          static_cast<std::uint8_t>(angle_q6 >> 7U), static_cast<std::uint8_t>(dist_q2 & 0xFFU),
          static_cast<std::uint8_t>(dist_q2 >> 8U)};
}

Bytes stream_of(std::uint32_t first, std::uint32_t count) {
  Bytes stream;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Bytes node = node_bytes(first + i);
    stream.insert(stream.end(), node.begin(), node.end());
  }
  return stream;
}

Bytes capsule(std::uint32_t start_q6, bool first, std::uint16_t dist_mm) {
  Bytes bytes(84);
  store_u16_le(bytes, 2, static_cast<std::uint16_t>(start_q6 | (first ? 0x8000U : 0U)));
  for (std::size_t i = 0; i < 40; ++i) { store_u16_le(bytes, 4 + 2 * i, dist_mm); }
  const std::uint8_t sum = xor8(std::span<const std::uint8_t>{bytes}.subspan(2));
  bytes[0] = static_cast<std::uint8_t>(0xA0U | (sum & 0xFU));
  bytes[1] = static_cast<std::uint8_t>(0x50U | (sum >> 4U));
  return bytes;
}

TEST(RplidarMessages, GivenThePublishedRequestsAndDescriptorsThenTheBytesAreTheSame) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("RPLIDAR");
  ASSERT_EQ(vectors.size(), 14U);
  const std::map<std::string, RplidarCommand> commands{
      {"rplidar-stop", RplidarCommand::stop},
      {"rplidar-reset", RplidarCommand::reset},
      {"rplidar-scan", RplidarCommand::scan},
      {"rplidar-force_scan", RplidarCommand::force_scan},
      {"rplidar-get_info", RplidarCommand::info},
      {"rplidar-get_health", RplidarCommand::health},
      {"rplidar-get_samplerate", RplidarCommand::sample_rate},
      {"rplidar-express_legacy", RplidarCommand::express_scan}};
  for (const ByteVector& vector : vectors) {
    SCOPED_TRACE(vector.id);
    const auto command = commands.find(vector.id);
    if (command != commands.end()) {
      std::array<std::uint8_t, kRplidarMaxRequest> out{};
      const std::array<std::uint8_t, 5> payload{};
      const bool express = command->second == RplidarCommand::express_scan;
      const std::size_t size =
          encode_rplidar(command->second, express ? ByteView{payload} : ByteView{}, out);
      EXPECT_EQ((Bytes{out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size)}),
                vector.bytes);
      continue;
    }
    RplidarDescriptorFinder finder;
    bool found = false;
    for (const std::uint8_t byte : join({{0x00, 0xA5}, vector.bytes})) {
      found = finder.push(byte);
    }
    ASSERT_TRUE(found);
    EXPECT_EQ(finder.found().length, vector.expected.at("len").get<unsigned>());
    EXPECT_EQ(finder.found().mode, vector.expected.at("mode").get<unsigned>());
    EXPECT_EQ(finder.found().type, vector.expected.at("type").get<unsigned>());
  }
}

/// A device that answers as an A1 does.
class FakeRplidar {
 public:
  explicit FakeRplidar(FakeSerialPort& port) : port_(port) {}
  std::uint8_t health = 0;
  bool mute = false;

  void live(Timestamp now) {
    for (; seen_ < port_.written().size(); ++seen_) {
      const std::uint8_t byte = port_.written()[seen_];
      if (last_ == 0xA5 && !mute) { obey(byte, now); }
      last_ = last_ == 0xA5 ? 0 : byte;
    }
    if (scanning_ && !mute) {
      port_.arrives(now, stream_of(node_, 10));
      node_ += 10;
    }
  }

 private:
  void obey(std::uint8_t command, Timestamp now) {
    if (command == 0x25) { scanning_ = false; }
    if (command == 0x50) {
      port_.arrives(now, from_hex("A55A1400000004 18 1D 01 07 000102030405060708090A0B0C0D0E0F"));
    }
    if (command == 0x52) { port_.arrives(now, join({from_hex("A55A0300000006"), {health, 0, 0}})); }
    if (command == 0x20) {
      port_.arrives(now, from_hex("A55A0500004081"));
      scanning_ = true;
    }
  }

  FakeSerialPort& port_;
  std::size_t seen_ = 0;
  std::uint8_t last_ = 0;
  bool scanning_ = false;
  std::uint32_t node_ = 0;
};

struct Session {
  FakeSerialPort port{115'200};
  FakeRplidar device{port};
  Rplidar lidar{port};
  Timestamp now{1s};
  std::size_t readings = 0;

  void run(Duration duration) {
    std::array<RangeReading, 48> out{};
    for (const Timestamp end = now + duration; now < end; now += 5ms) {
      device.live(now);
      for (auto n = lidar.poll(256, out); n; n = lidar.poll(256, out)) { readings += *n; }
      ASSERT_EQ(lidar.service(now), Status::ok);
    }
  }
};

TEST(Rplidar, GivenADeviceThenItIsStoppedAskedAndStarted) {
  Session session;
  session.run(1s);
  EXPECT_GT(session.readings, 1000U);
  EXPECT_EQ(session.lidar.protocol().info().model, 0x18);
  EXPECT_EQ(session.lidar.protocol().info().firmware_major, 1);
  EXPECT_EQ(session.lidar.protocol().health(), RplidarHealth::good);
  EXPECT_EQ(session.lidar.protocol().trouble(), RplidarTrouble::none);
  EXPECT_EQ(session.lidar.counters().restarts, 0U);
  EXPECT_EQ(session.lidar.stop(), Status::ok);
  EXPECT_EQ(session.port.written().back(), 0x25);
  const std::size_t before = session.readings;
  session.run(3s);
  EXPECT_LT(session.readings, before + 20);  // it stays stopped
}

TEST(Rplidar, GivenSilenceThenItIsToldAndTheDeviceIsStartedAgain) {
  Session session;
  session.run(1s);
  session.device.mute = true;
  session.run(3s);
  EXPECT_EQ(session.lidar.protocol().trouble(), RplidarTrouble::no_bytes);
  EXPECT_GE(session.lidar.counters().restarts, 1U);
  session.device.mute = false;
  const std::size_t before = session.readings;
  session.run(2s);
  EXPECT_GT(session.readings, before + 1000);
  EXPECT_EQ(session.lidar.protocol().trouble(), RplidarTrouble::none);
}

TEST(Rplidar, GivenAnotherBaudRateThenItIsToldFromSilenceAndFromIllness) {
  Session session;
  session.device.mute = true;
  std::array<RangeReading, 48> out{};
  for (int i = 0; i < 400; ++i) {
    session.now += 5ms;
    session.port.arrives(session.now, noise(20, static_cast<std::uint64_t>(i)));
    static_cast<void>(session.lidar.poll(256, out));
    static_cast<void>(session.lidar.service(session.now));
  }
  EXPECT_EQ(session.lidar.protocol().trouble(), RplidarTrouble::no_descriptor);
  Session ill;
  ill.device.health = 2;
  ill.run(1s);
  EXPECT_EQ(ill.lidar.protocol().trouble(), RplidarTrouble::unhealthy);
  EXPECT_EQ(ill.readings, 0U);
}

TEST(Rplidar, GivenTurnsThenBearingsRunClockwiseAndStampsNeverBack) {
  FakeSerialPort port{115'200};
  Rplidar lidar{port, {.active = false}};
  port.arrives(Timestamp{1s}, stream_of(0, 1000));
  std::array<RangeReading, 48> out{};
  std::vector<RangeReading> all;
  for (auto n = lidar.poll(100'000, out); n; n = lidar.poll(100'000, out)) {
    all.insert(all.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(*n));
  }
  ASSERT_EQ(all.size(), 996U);  // four wait for what follows them
  int starts = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    starts += all[i].starts_sweep ? 1 : 0;
    const double expected = -2 * std::numbers::pi * static_cast<double>(i % 320) / 320;
    EXPECT_NEAR(
        std::remainder(static_cast<double>(all[i].bearing_rad) - expected, 2 * std::numbers::pi),
        0.0, 4e-4);
    EXPECT_FLOAT_EQ(all[i].range_m, 0.001F * static_cast<float>(1000 + i % 997));
    if (i > 0) { EXPECT_GE(all[i].stamp, all[i - 1].stamp); }
  }
  EXPECT_EQ(starts, 4);
}

TEST(Rplidar, GivenCapsulesThenTheirNodesAreStampedBeforeTheirOwnFirstBit) {
  FakeSerialPort port{1'000'000};
  Rplidar lidar{port, {.mode = RplidarMode::dense, .samples_per_second = 5000, .active = false}};
  std::array<RangeReading, 96> out{};
  for (std::uint32_t i = 0; i < 10; ++i) {
    const Timestamp arrived = Timestamp{1s} + i * 8ms;
    port.arrives(arrived, capsule(i * 36 * 64 % (360 * 64), i == 0, 1000));
    const auto count = lidar.poll(200, out);
    if (i == 0) { continue; }
    ASSERT_TRUE(count);
    ASSERT_EQ(*count, 40U);
    const Timestamp first_bit = arrived - 8ms - transmission_time(84, 1'000'000);
    EXPECT_EQ(out[39].stamp, first_bit);
    EXPECT_EQ(out[0].stamp, first_bit - 7800us) << "39 of 5000 a second before";
  }
}

TEST(RplidarCapsules, GivenADenseStreamWithALostCapsuleThenOnlyThatOneIsMissing) {
  RplidarCapsules capsules{RplidarMode::dense};
  std::array<RplidarNode, kRplidarMaxNodes> nodes{};
  std::vector<RplidarNode> all;
  for (std::uint32_t i = 0; i < 20; ++i) {
    Bytes bytes = capsule(i * 36 * 64 % (360 * 64), i == 0, static_cast<std::uint16_t>(100 + i));
    if (i == 10) { bytes[50] ^= 4U; }
    for (const std::uint8_t byte : bytes) {
      const std::size_t count = capsules.push(byte, nodes);
      all.insert(all.end(), nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }
  ASSERT_EQ(all.size(), 18U * 40U);  // the last one waits for its successor
  int starts = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t packet = i / 40 < 10 ? i / 40 : i / 40 + 1;
    EXPECT_EQ(all[i].dist_mm_q2, 4 * (100 + packet));
    const double angle = static_cast<double>(all[i].angle_z_q14) * 90 / 16384;
    const double expected = static_cast<double>(packet) * 36 + static_cast<double>(i % 40) * 0.9;
    EXPECT_NEAR(std::remainder(angle - expected, 360.0), 0.0, 0.05);
    starts += static_cast<int>(all[i].flag & 1U);
  }
  EXPECT_EQ(starts, 1);
  EXPECT_EQ(capsules.counters().bad_checksums, 1U);
}

}  // namespace
}  // namespace picolo::test
