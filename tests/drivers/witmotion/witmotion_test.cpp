// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/witmotion/witmotion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "support/fake_serial_port.hpp"
#include "support/vectors.hpp"
#include "witmotion_wire.hpp"

namespace picolo::test {
namespace {

static_assert(WitMotionConfig{}.valid());

std::vector<ImuSample> read_all(const std::vector<Bytes>& pieces, std::size_t room = 16) {
  FakeSerialPort port{100'000};  // 100 us a byte: no rounding
  Timestamp stamp{1s};
  for (const Bytes& piece : pieces) {
    stamp += transmission_time(piece.size(), port.baud());
    port.arrives(stamp, piece);
  }
  WitMotion imu{port};
  std::vector<ImuSample> all;
  std::array<ImuSample, 16> samples{};
  for (auto n = imu.poll(97, std::span{samples}.first(room)); n;
       n = imu.poll(97, std::span{samples}.first(room))) {
    all.insert(all.end(), samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(*n));
  }
  return all;
}

bool equal(const std::vector<ImuSample>& a, const std::vector<ImuSample>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const ImuSample& x, const ImuSample& y) {
        return x.stamp == y.stamp && x.source == y.source && x.saturated == y.saturated &&
               x.acceleration_mps2 == y.acceleration_mps2 && x.rate_radps == y.rate_radps;
      });
}

TEST(WitMotionShell, GivenRecordedStreamsThenTheSampleCarriesThePublishedValues) {
  PICOLO_NEED_DATA(kVectorFile);
  for (const ByteVector& vector : byte_vectors("WitMotion standard")) {
    SCOPED_TRACE(vector.id);
    const auto samples = read_all({vector.bytes});
    ASSERT_EQ(samples.size(), 1U);
    EXPECT_EQ(samples[0].stamp, Timestamp{1s});
    EXPECT_FALSE(samples[0].saturated);
    for (const auto& frame : vector.expected.at("frames")) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (frame.contains("accel_g")) {
          EXPECT_NEAR(samples[0].acceleration_mps2.at(i),
                      frame.at("accel_g")[i].get<double>() * 9.80665, 1e-5);
        }
        if (frame.contains("gyro_dps")) {
          EXPECT_NEAR(samples[0].rate_radps.at(i),
                      frame.at("gyro_dps")[i].get<double>() * std::numbers::pi / 180.0, 1e-6);
        }
      }
    }
  }
}

TEST(WitMotionShell, GivenAnyCutOfTheStreamThenTheSamplesAreTheSame) {
  Bytes stream;
  for (int i = 0; i < 60; ++i) {
    stream = join({stream, wire_group(i), i % 7 == 0 ? Bytes{0x55, 0x51, 0x55} : Bytes{}});
  }
  const auto whole = read_all({stream});
  ASSERT_EQ(whole.size(), 60U);
  std::vector<Bytes> single;
  for (const std::uint8_t byte : stream) { single.push_back({byte}); }
  EXPECT_TRUE(equal(read_all(single), whole));
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    EXPECT_TRUE(equal(read_all(cut_randomly(stream, 1 + seed * 2, seed)), whole))
        << "seed " << seed;
  }
}

TEST(WitMotionShell, GivenLittleRoomThenNoSampleIsLost) {
  Bytes stream;
  for (int i = 0; i < 40; ++i) { stream = join({stream, wire_group(i)}); }
  const auto whole = read_all({stream});
  ASSERT_EQ(whole.size(), 40U);
  for (std::size_t room = 1; room < 5; ++room) {
    EXPECT_TRUE(equal(read_all({stream}, room), whole)) << room;
  }
}

TEST(WitMotionShell, GivenAGroupThenItIsStampedWithTheFirstBitOfItsFirstFrame) {
  FakeSerialPort port{9600};
  port.stamps_come_from(StampSource::hardware);
  WitMotion imu{port};
  std::array<ImuSample, 4> samples{};
  port.arrives(Timestamp{1s}, wire_group(1));
  ASSERT_EQ(imu.poll(100, samples).value_or(0), 1U);
  EXPECT_EQ(samples[0].stamp, Timestamp{1s} - transmission_time(33, 9600));
  EXPECT_EQ(samples[0].source, StampSource::hardware);
  EXPECT_EQ(imu.angles().stamp, samples[0].stamp);
}

TEST(WitMotionShell, GivenBudgetRoomAndLineThenStatusesAreAsDocumented) {
  FakeSerialPort port{115'200};
  WitMotion imu{port};
  std::array<ImuSample, 4> samples{};
  EXPECT_EQ(imu.poll(100, samples).status(), Status::not_ready);
  port.arrives(Timestamp{1s}, wire_group(1));
  EXPECT_EQ(imu.poll(100, std::span<ImuSample>{}).status(), Status::invalid_argument);
  EXPECT_EQ(port.waiting(), 33U);
  EXPECT_EQ(imu.poll(12, samples).status(), Status::not_ready);
  EXPECT_EQ(port.waiting(), 21U);
  EXPECT_EQ(imu.poll(100, samples).value_or(0), 1U);
  port.disconnect();
  EXPECT_EQ(imu.poll(100, samples).status(), Status::disconnected);
  port.reconnect();
  port.arrives(Timestamp{2s}, wire_group(2));
  EXPECT_EQ(imu.poll(100, samples).value_or(0), 1U);
}

TEST(WitMotionShell, GivenDamageThenCountersTellWhatWasRejected) {
  FakeSerialPort port{115'200};
  WitMotion imu{port};
  std::array<ImuSample, 4> samples{};
  Bytes damaged = wire_frame(0x51, {1, 2, 3, 4});
  damaged[5] ^= 0x80U;
  port.arrives(Timestamp{1s},
               join({{0x01}, damaged, wire_frame(0x52, {1, 2, 32767, 4}), wire_group(3)}));
  EXPECT_EQ(imu.poll(100, samples).value_or(0), 1U);
  const WitMotionCounters counters = imu.counters();
  EXPECT_EQ(counters.bytes, 56U);
  EXPECT_EQ(counters.frames, 4U);
  EXPECT_EQ(counters.bad_checksums, 1U);
  EXPECT_EQ(counters.skipped_bytes, 12U);
  EXPECT_EQ(counters.samples, 1U);
  EXPECT_EQ(counters.incomplete, 1U);
  EXPECT_EQ(counters.saturated, 0U);
}

}  // namespace
}  // namespace picolo::test
