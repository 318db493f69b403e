// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "ld06_wire.hpp"
#include "picolo/core/random.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"

namespace picolo::test {
namespace {

using PacketReadings = std::array<RangeReading, kLd06PointsPerPacket>;

PacketReadings convert(Ld06Readings& readings, const Ld06Packet& packet) {
  PacketReadings result{};
  readings.convert(packet, result);
  return result;
}

/// How many of the packet's readings start a sweep.
int starts(Ld06Readings& readings, unsigned start_cdeg, unsigned span) {
  Ld06Packet packet = spinning_packet(0);
  packet.start_cdeg = static_cast<std::uint16_t>(start_cdeg % 36000);
  packet.end_cdeg = static_cast<std::uint16_t>((start_cdeg + span) % 36000);
  int count = 0;
  for (const RangeReading& reading : convert(readings, packet)) {
    count += reading.starts_sweep ? 1 : 0;
  }
  return count;
}

TEST(Ld06Readings, GivenClockwiseAnglesThenBearingsRunCounterClockwiseInMinusPiToPi) {
  constexpr double kPi = std::numbers::pi;
  for (unsigned start = 0; start <= 36000; start += 7) {
    Ld06Packet packet = spinning_packet(0);
    packet.start_cdeg = static_cast<std::uint16_t>(start);
    packet.end_cdeg = static_cast<std::uint16_t>((start + 931) % 36000);
    Ld06Readings readings;
    const PacketReadings result = convert(readings, packet);
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double device_deg = start / 100.0 + static_cast<double>(i) * 9.31 / 11.0;
      const double expected = std::remainder(-device_deg * kPi / 180.0, 2.0 * kPi);
      const auto bearing = static_cast<double>(result.at(i).bearing_rad);
      ASSERT_LE(std::abs(bearing), static_cast<double>(std::numbers::pi_v<float>));
      ASSERT_NEAR(std::remainder(bearing - expected, 2.0 * kPi), 0.0, 4e-7) << device_deg;
    }
  }
}

TEST(Ld06Readings, GivenDistancesThenRangesAreMetresAndZeroStaysZeroWhateverItsIntensity) {
  Ld06Packet packet = spinning_packet(0);
  packet.points[0] = {0, 255};
  packet.points[1] = {1, 0};
  packet.points[2] = {65535, 3};
  Ld06Readings readings;
  const PacketReadings result = convert(readings, packet);
  EXPECT_EQ(result[0].range_m, 0.0F);
  EXPECT_EQ(result[1].range_m, 0.001F);
  EXPECT_EQ(result[2].range_m, 65.535F);
  EXPECT_EQ(result[3].range_m, 1.003F);
}

TEST(Ld06Readings, GivenTheIntensityRuleThenWeakFarPointsBecomeInvalidAndOthersStay) {
  Ld06Packet packet = spinning_packet(0);
  packet.points[0] = {5000, 14};
  packet.points[1] = {5000, 15};
  packet.points[2] = {300, 14};
  Ld06Readings readings{Ld06ReadingConfig{.min_intensity = 15, .weak_beyond_mm = 300}};
  const PacketReadings result = convert(readings, packet);
  EXPECT_EQ(result[0].range_m, 0.0F);
  EXPECT_EQ(result[1].range_m, 5.0F);
  EXPECT_EQ(result[2].range_m, 0.3F);
}

TEST(Ld06Readings, GivenASteadyTurnThenEachRevolutionStartsOnceAtTheFirstAngleAfterZero) {
  Ld06Readings readings;
  unsigned since_start = 0;
  int revolutions = 0;
  for (unsigned index = 0; index < 375 * 4; ++index) {
    for (const RangeReading& reading : convert(readings, spinning_packet(index))) {
      ++since_start;
      if (!reading.starts_sweep) { continue; }
      ++revolutions;
      // just behind the x axis, which a clockwise lidar passes from positive to negative bearings
      ASSERT_LE(reading.bearing_rad, 0.0F);
      ASSERT_GT(reading.bearing_rad, -0.015F);
      if (revolutions > 1) { ASSERT_EQ(since_start, 450U); }
      since_start = 0;
    }
  }
  EXPECT_EQ(revolutions, 39);  // the 40th begins with the packet after the last
}

TEST(Ld06Readings, GivenPacketsThatOverlapAroundZeroThenTheRevolutionStartsOnlyOnce) {
  Ld06Readings readings;
  EXPECT_EQ(starts(readings, 34000, 900), 0);
  EXPECT_EQ(starts(readings, 35200, 900), 1);  // ends at 1.00 deg
  EXPECT_EQ(starts(readings, 35900, 900), 0);  // begins again before 360 deg
  EXPECT_EQ(starts(readings, 35950, 900), 0);
  for (unsigned angle = 900; angle < 35000; angle += 900) {
    ASSERT_EQ(starts(readings, angle, 800), 0);
  }
  EXPECT_EQ(starts(readings, 35400, 900), 1);
}

TEST(Ld06Readings, GivenPacketsLostAroundZeroThenTheRevolutionStartsAtTheFirstReadingBehindTheGap) {
  Ld06Readings readings;
  for (unsigned angle = 10000; angle < 34000; angle += 900) {
    ASSERT_EQ(starts(readings, angle, 800), 0);
  }
  Ld06Packet packet = spinning_packet(0);
  packet.start_cdeg = 5000;
  packet.end_cdeg = 5880;
  const PacketReadings result = convert(readings, packet);
  EXPECT_TRUE(result[0].starts_sweep);
  EXPECT_FALSE(result[1].starts_sweep);
}

TEST(Ld06Readings, GivenTheFirstPassageSoonAfterPowerUpThenItCounts) {
  Ld06Readings readings;
  EXPECT_EQ(starts(readings, 35500, 900), 1);
}

TEST(Ld06Readings, GivenAMotorWithUnsteadySpeedThenStartsAreAtLeastHalfATurnApart) {
  Random random{7};
  Ld06Readings readings;
  double angle_cdeg = 100.0;
  int since_start = 0;
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    Ld06Packet packet = spinning_packet(0);
    const double jitter_cdeg = random.uniform(-120.0, 120.0);
    const double start = std::fmod(angle_cdeg + jitter_cdeg + 36000.0, 36000.0);
    packet.start_cdeg = static_cast<std::uint16_t>(start);
    packet.end_cdeg = static_cast<std::uint16_t>((packet.start_cdeg + 880) % 36000);
    angle_cdeg += 960.0;
    for (const RangeReading& reading : convert(readings, packet)) {
      ++since_start;
      if (!reading.starts_sweep) { continue; }
      if (found > 0) { ASSERT_GT(since_start, 400); }
      since_start = 0;
      ++found;
    }
  }
  EXPECT_NEAR(found, 5000 * 960 / 36000, 1);
}

}  // namespace
}  // namespace picolo::test
