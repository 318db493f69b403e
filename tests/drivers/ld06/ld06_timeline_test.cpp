// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06_timeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo::test {
namespace {

using PacketReadings = std::array<RangeReading, kLd06PointsPerPacket>;

PacketReadings stamp(Ld06Timeline& timeline, Timestamp first_bit, std::uint16_t timestamp_ms = 0) {
  PacketReadings readings{};
  timeline.stamp(first_bit, timestamp_ms, readings);
  return readings;
}

Ld06TimelineConfig host_only() {
  return {.use_device_clock = false};
}

/// Packet k of a device that sends one every 12 / 4500 s: when it went out, and what its counter
/// says.
Timestamp sent(int k) {
  return Timestamp{10s} + Duration{k * 8000 / 3};
}
std::uint16_t device_ms(int k) {
  return static_cast<std::uint16_t>((29'500 + k * 8 / 3) % 30'000);
}

TEST(Ld06Timeline, GivenAPacketThenItsLastPointWasMeasuredLatencyBeforeItsFirstBit) {
  Ld06TimelineConfig config = host_only();
  config.latency = 300us;
  Ld06Timeline timeline{config};
  const PacketReadings readings = stamp(timeline, Timestamp{1s});
  EXPECT_EQ(readings[11].stamp, Timestamp{1s} - 300us);
  EXPECT_EQ(readings[0].stamp, Timestamp{1s} - 300us - 2444us);  // 11 / 4500 s
  EXPECT_EQ(timeline.last_stamp(), readings[11].stamp);
}

TEST(Ld06Timeline, GivenPerfectStampsThenPointsAreEquallySpacedAcrossPackets) {
  for (const bool use_device_clock : {false, true}) {
    Ld06Timeline timeline{Ld06TimelineConfig{.use_device_clock = use_device_clock}};
    Timestamp previous{};
    for (int k = 0; k < 3000; ++k) {
      for (const RangeReading& reading : stamp(timeline, sent(k), device_ms(k))) {
        if (previous != Timestamp{}) {
          ASSERT_GE(reading.stamp - previous, 221us);
          ASSERT_LE(reading.stamp - previous, 224us);
        }
        previous = reading.stamp;
      }
      ASSERT_EQ(previous, sent(k)) << "the filter must not touch perfect stamps";
    }
    EXPECT_EQ(timeline.clock_restarts(), 0U);
  }
}

TEST(Ld06Timeline, GivenAnotherSamplingRateThenTheSpacingFollows) {
  Ld06TimelineConfig config = host_only();
  config.points_per_second = 5000;
  Ld06Timeline timeline{config};
  const PacketReadings readings = stamp(timeline, Timestamp{1s});
  for (std::size_t i = 1; i < readings.size(); ++i) {
    EXPECT_EQ(readings.at(i).stamp - readings.at(i - 1).stamp, 200us);
  }
}

TEST(Ld06Timeline, GivenAPacketThatSeemsToOverlapThenItIsSqueezedBehindItsPredecessor) {
  Ld06Timeline timeline{host_only()};
  static_cast<void>(stamp(timeline, Timestamp{1s}));
  const PacketReadings readings = stamp(timeline, Timestamp{1s} + 1200us);
  EXPECT_EQ(readings[0].stamp, Timestamp{1s} + 100us);
  EXPECT_EQ(readings[5].stamp, Timestamp{1s} + 600us);
  EXPECT_EQ(readings[11].stamp, Timestamp{1s} + 1200us);
}

TEST(Ld06Timeline, GivenAStampBeforeItsPredecessorThenTimeStandsStillInsteadOfRunningBack) {
  Ld06Timeline timeline{host_only()};
  static_cast<void>(stamp(timeline, Timestamp{1s}));
  for (const RangeReading& reading : stamp(timeline, Timestamp{1s} - 5ms)) {
    EXPECT_EQ(reading.stamp, Timestamp{1s});
  }
  EXPECT_EQ(stamp(timeline, Timestamp{1s} + 10ms)[11].stamp, Timestamp{1s} + 10ms);
}

TEST(Ld06Timeline, GivenStampsWithJitterThenTheOutputHasLessAndNeverRunsBack) {
  Random random{3};
  Ld06Timeline with_clock{};
  Ld06Timeline without_clock{host_only()};
  Timestamp previous{};
  Duration worst{};
  Duration worst_host{};
  for (int k = 0; k < 20'000; ++k) {
    const Timestamp late = sent(k) + Duration{random.below(8000)};  // a host that looks every 8 ms
    const PacketReadings readings = stamp(with_clock, late, device_ms(k));
    for (const RangeReading& reading : readings) {
      ASSERT_GE(reading.stamp, previous);
      previous = reading.stamp;
    }
    if (k < 50) { continue; }
    ASSERT_GE(readings[11].stamp, sent(k) - 1us);
    worst = std::max(worst, readings[11].stamp - sent(k));
    worst_host = std::max(worst_host, stamp(without_clock, late)[11].stamp - sent(k));
  }
  EXPECT_LE(worst, 2400us);  // fastest delivery of a window, counter's step, twice, drift
  EXPECT_GT(worst_host, 7500us);
}

}  // namespace
}  // namespace picolo::test
