// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Bytes arrive one by one at the rate of the line, and the stamp of the last one read is exact.

#include "picolo/sim/sim_serial_port.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/sim/sim_clock.hpp"

namespace picolo::sim {
namespace {

class SimSerialPortTest : public ::testing::Test {
 protected:
  static std::vector<std::uint8_t> sequence(std::size_t size) {
    std::vector<std::uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
    return bytes;
  }

  SimClock clock{Timestamp{1s}};
  SimSerialPort port{clock, 115'200};
  std::array<std::uint8_t, 64> buffer{};
};

TEST_F(SimSerialPortTest, GivenNothingThenNotReady) {
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
}

TEST_F(SimSerialPortTest, GivenBytesUnderWayThenEachArrivesAtItsOwnTime) {
  const Timestamp start = clock.now();
  const Timestamp end = port.deliver(sequence(11), start);
  EXPECT_EQ(end, start + transmission_time(11, 115'200));
  std::size_t seen = 0;
  for (; clock.now() < end; clock.advance(1us)) {
    const auto read = port.read(buffer);
    if (!read) { continue; }
    seen += read->size;
    EXPECT_EQ(read->last_byte_stamp, clock.now());
    EXPECT_EQ(clock.now(), start + transmission_time(seen, 115'200));
  }
  EXPECT_EQ(seen, 10U);
  EXPECT_EQ(port.read(buffer)->last_byte_stamp, end);
}

TEST_F(SimSerialPortTest, GivenOverlappingDeliveriesThenTheLineSerialisesThem) {
  const Timestamp first = port.deliver(sequence(33), clock.now());
  const Timestamp second = port.deliver(sequence(33), clock.now());
  EXPECT_EQ(second - first, transmission_time(33, 115'200));
}

TEST_F(SimSerialPortTest, GivenRandomChunksThenBytesStayInOrderAndStampsNeverDecrease) {
  Random random{5};
  std::vector<std::uint8_t> sent;
  std::vector<std::uint8_t> got;
  Timestamp last{};
  for (int round = 0; round < 400; ++round) {
    const auto bytes = sequence(random.below(60));
    port.deliver(bytes, clock.now());
    sent.insert(sent.end(), bytes.begin(), bytes.end());
    clock.advance(Duration{random.below(6000)});
    const std::span<std::uint8_t> part{buffer.data(), 1 + random.below(64)};
    const auto read = port.read(part);
    if (!read) { continue; }
    EXPECT_GE(read->last_byte_stamp, last);
    EXPECT_LE(read->last_byte_stamp, clock.now());
    last = read->last_byte_stamp;
    got.insert(got.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(read->size));
  }
  clock.advance(10s);
  for (auto read = port.read(buffer); read; read = port.read(buffer)) {
    got.insert(got.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(read->size));
  }
  EXPECT_EQ(got, sent);
  EXPECT_EQ(port.lost(), 0U);
}

TEST_F(SimSerialPortTest, GivenAFullLineThenTheNewestBytesAreLostAndCounted) {
  const auto block = sequence(1024);
  for (std::size_t i = 0; i < SimSerialPort::kReceiveCapacity / 1024; ++i) {
    port.deliver(block, clock.now());
  }
  EXPECT_EQ(port.lost(), 0U);
  port.deliver(sequence(7), clock.now());
  EXPECT_EQ(port.lost(), 7U);
}

TEST_F(SimSerialPortTest, WhenTheFirmwareWritesThenTheVehicleTakesTheBytesInOrder) {
  ASSERT_EQ(port.write(sequence(5)).value_or(0), 5U);
  ASSERT_EQ(port.take_written(buffer), 5U);
  EXPECT_EQ(buffer[4], 4U);
  const auto much = sequence(SimSerialPort::kTransmitCapacity + 10);
  EXPECT_EQ(port.write(much).value_or(0), SimSerialPort::kTransmitCapacity);
  EXPECT_EQ(port.write(much).status(), Status::full);
}

TEST_F(SimSerialPortTest, GivenAnUnpluggedLineThenItSaysSoAndComesBackEmpty) {
  port.deliver(sequence(20), clock.now());
  port.set_connected(false);
  clock.advance(1s);
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
  EXPECT_EQ(port.write(sequence(1)).status(), Status::disconnected);
  port.deliver(sequence(20), clock.now());
  port.set_connected(true);
  clock.advance(1s);
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
  port.deliver(sequence(3), clock.now());
  clock.advance(1s);
  EXPECT_EQ(port.read(buffer)->size, 3U);
}

}  // namespace
}  // namespace picolo::sim
