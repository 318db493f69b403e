// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "ld06_wire.hpp"
#include "support/fake_serial_port.hpp"

namespace picolo::test {
namespace {

static_assert(Ld06Config{}.valid());
static_assert(!Ld06Config{.format = {.min_points_per_second = 0}}.valid());
static_assert(!Ld06Config{.timeline = {.points_per_second = 0}}.valid());

class Ld06Shell : public testing::Test {
 protected:
  void arrives(unsigned packet, Timestamp stamp) {
    port_.arrives(stamp, wire_bytes(spinning_packet(packet)));
  }

  FakeSerialPort port_{230'400};
  Ld06 lidar_{port_};
  std::array<RangeReading, 480> readings_{};
};

TEST_F(Ld06Shell, GivenNothingThenNotReady) {
  EXPECT_EQ(lidar_.poll(1000, readings_).status(), Status::not_ready);
  EXPECT_EQ(lidar_.speed_degps(), 0);
}

TEST_F(Ld06Shell, GivenOnePacketThenTwelveReadingsStampedByItsTimeOnTheWire) {
  arrives(0, Timestamp{1s});
  const auto count = lidar_.poll(1000, readings_);
  ASSERT_TRUE(count);
  EXPECT_EQ(*count, 12U);
  EXPECT_EQ(readings_[11].stamp, Timestamp{1s} - transmission_time(47, 230'400));
  EXPECT_EQ(lidar_.last_stamp(), readings_[11].stamp);
  EXPECT_EQ(lidar_.speed_degps(), 3600);
  EXPECT_EQ(lidar_.poll(1000, readings_).status(), Status::not_ready);
}

TEST_F(Ld06Shell, GivenLessThanAPacketOfRoomThenInvalidArgumentAndNothingIsRead) {
  arrives(0, Timestamp{1s});
  EXPECT_EQ(lidar_.poll(1000, std::span{readings_}.first(11)).status(), Status::invalid_argument);
  EXPECT_EQ(port_.waiting(), 47U);
}

TEST_F(Ld06Shell, GivenMoreBytesThanTheBudgetThenItReadsNoMoreThanTheBudget) {
  for (unsigned i = 0; i < 10; ++i) { arrives(i, Timestamp{1s} + i * 3ms); }
  EXPECT_EQ(lidar_.poll(40, readings_).status(), Status::not_ready);
  EXPECT_EQ(port_.waiting(), 430U);
  const auto count = lidar_.poll(60, readings_);
  ASSERT_TRUE(count);
  EXPECT_EQ(*count, 24U);
  EXPECT_EQ(port_.waiting(), 370U);
  EXPECT_EQ(lidar_.poll(0, readings_).status(), Status::not_ready);
  EXPECT_EQ(port_.waiting(), 370U);
}

TEST_F(Ld06Shell, GivenLittleRoomThenNoReadingIsLost) {
  for (std::size_t room = 12; room < 60; room += 5) {
    FakeSerialPort port;
    Ld06 lidar{port};
    std::vector<float> ranges;
    for (unsigned i = 0; i < 40; ++i) {
      port.arrives(Timestamp{1s} + i * 3ms,
                   wire_bytes(spinning_packet(i, static_cast<std::uint16_t>(100 * i + 1))));
    }
    for (auto n = lidar.poll(333, std::span{readings_}.first(room)); n;
         n = lidar.poll(333, std::span{readings_}.first(room))) {
      ASSERT_LE(*n, room);
      for (std::size_t k = 0; k < *n; ++k) { ranges.push_back(readings_.at(k).range_m); }
    }
    ASSERT_EQ(ranges.size(), 480U) << "room " << room;
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      ASSERT_EQ(ranges[k], static_cast<float>(k / 12 * 100 + 1 + k % 12) / 1000.0F);
    }
  }
}

TEST_F(Ld06Shell, GivenPacketsInOneBatchThenEachIsStampedByItsOwnPlaceInTheBatch) {
  Bytes batch;
  for (unsigned i = 0; i < 3; ++i) { batch = join({batch, wire_bytes(spinning_packet(i))}); }
  port_.arrives(Timestamp{1s}, batch);
  ASSERT_EQ(lidar_.poll(1000, readings_).value_or(0), 36U);
  EXPECT_EQ(readings_[11].stamp, Timestamp{1s} - transmission_time(3 * 47, 230'400));
  EXPECT_EQ(readings_[35].stamp, Timestamp{1s} - transmission_time(47, 230'400));
  for (std::size_t i = 1; i < 36; ++i) {
    EXPECT_GE(readings_.at(i).stamp, readings_.at(i - 1).stamp);
  }
}

TEST_F(Ld06Shell, GivenAnUnpluggedDeviceThenDisconnectedAndWhenItReturnsItGoesOn) {
  const Bytes packet = wire_bytes(spinning_packet(0));
  port_.arrives(Timestamp{1s}, Bytes{packet.begin(), packet.begin() + 20});
  EXPECT_EQ(lidar_.poll(1000, readings_).status(), Status::not_ready);
  port_.disconnect();
  EXPECT_EQ(lidar_.poll(1000, readings_).status(), Status::disconnected);
  port_.reconnect();
  arrives(1, Timestamp{60s});
  EXPECT_EQ(lidar_.poll(1000, readings_).value_or(0), 12U);
  EXPECT_EQ(readings_[0].range_m, 1.0F);
}

TEST_F(Ld06Shell, GivenDamageThenCountersTellWhatWasRejected) {
  Bytes damaged = wire_bytes(spinning_packet(0));
  damaged[20] ^= 1U;
  Ld06Packet wild = spinning_packet(1);
  wild.end_cdeg = static_cast<std::uint16_t>(wild.start_cdeg + 9000);
  port_.arrives(Timestamp{1s},
                join({{0x00, 0x11}, damaged, wire_bytes(wild), wire_bytes(spinning_packet(2))}));
  EXPECT_EQ(lidar_.poll(1000, readings_).value_or(0), 12U);
  const Ld06Counters counters = lidar_.counters();
  EXPECT_EQ(counters.bytes, 2U + 3U * 47U);
  EXPECT_EQ(counters.packets, 1U);
  EXPECT_EQ(counters.bad_checksums, 1U);
  EXPECT_EQ(counters.implausible, 1U);
  EXPECT_EQ(counters.skipped_bytes, 2U + 2U * 47U);
  EXPECT_EQ(counters.clock_restarts, 0U);
}

/// A port that answers ok without bytes, against its contract.
class EmptyPort final : public SerialPort {
 public:
  Result<SerialRead> read(std::span<std::uint8_t> /*buffer*/) override { return SerialRead{}; }
  Result<std::size_t> write(std::span<const std::uint8_t> /*bytes*/) override {
    return Status::full;
  }
  [[nodiscard]] std::uint32_t baud() const override { return 230'400; }
  [[nodiscard]] std::uint32_t lost() const override { return 0; }
};

TEST_F(Ld06Shell, GivenAPortThatReadsNothingForEverThenPollStillReturns) {
  EmptyPort port;
  Ld06 lidar{port};
  EXPECT_EQ(lidar.poll(1'000'000, readings_).status(), Status::not_ready);
}

}  // namespace
}  // namespace picolo::test
