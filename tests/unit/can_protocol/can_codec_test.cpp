// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/can_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "picolo/controller/command_gate.hpp"
#include "random_frames.hpp"

namespace picolo {
namespace {

using Bytes = std::array<std::uint8_t, 8>;
constexpr std::uint16_t kBase = 0x110;

TEST(CanCodec, RandomFramesComeBackAsTheyWere) {
  for (const test::RandomFrame& one : test::random_frames(kBase)) {
    const auto values = decode(*one.message, kBase, one.frame);
    ASSERT_TRUE(values) << one.message->name;
    EXPECT_EQ(values->raw, one.values.raw) << one.message->name;
    EXPECT_EQ(values->counter, one.values.counter);
  }
}

TEST(CanCodec, ValuesFromAWorkedExample) {
  // x 1.234 m = 617 = 0x00269 from bit 12, y -2 m = -1000 = 0x7FC18 from bit 31,
  // yaw 1.5 rad = 3750 = 0x0EA6 from bit 50, counter 5 in bits 8 to 11
  const auto& s = can_table::kPoseSignals;
  const std::array raw{to_raw(s[0], 1.2344), to_raw(s[1], -2.0), to_raw(s[2], 1.50001)};
  EXPECT_EQ(raw, (std::array<std::int64_t, 3>{617, -1000, 3750}));
  const CanFrame frame = encode(can_table::kPose, kBase, 5, raw);
  EXPECT_EQ(frame.id, 0x110U);
  EXPECT_EQ(frame.length, 8);
  Bytes data = frame.data;
  data[0] = 0;
  EXPECT_EQ(data, (Bytes{0x00, 0x95, 0x26, 0x00, 0x0C, 0xFE, 0x9B, 0x3A}));
}

TEST(CanCodec, TheCrcIsThatOfProfile1) {
  // CRC-8 with polynomial 0x1D and start 0 by hand: over C0 50 and seven zeros.
  std::uint8_t crc = 0;
  for (const int byte : {0xC0, 0x50, 0, 0, 0, 0, 0, 0, 0}) {
    crc = static_cast<std::uint8_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint8_t>((crc & 0x80) != 0 ? (crc << 1) ^ 0x1D : crc << 1);
    }
  }
  const CanFrame frame = encode(can_table::kPose, kBase, 0, {});
  EXPECT_EQ(frame.data, (Bytes{crc, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(CanCodec, EveryFlippedBitIsNoticed) {
  const CanFrame good = test::random_frames(kBase)[0].frame;
  for (std::size_t bit = 0; bit < 64; ++bit) {
    CanFrame bad = good;
    bad.data[bit / 8] = static_cast<std::uint8_t>(bad.data[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_EQ(decode(can_table::kPose, kBase, bad).status(), Status::checksum) << bit;
  }
}

TEST(CanCodec, AFrameOfAnotherMessageUnderThisIdentifierIsNoticed) {
  CanFrame frame = encode(can_table::kHealth, kBase, 1, {});
  frame.id = kBase;
  EXPECT_EQ(decode(can_table::kPose, kBase, frame).status(), Status::checksum);
  EXPECT_EQ(decode(can_table::kHealth, kBase, frame).status(), Status::invalid_argument);
}

TEST(CanCodec, ShapesThatAreWrongAreRefused) {
  const CanFrame good = encode(can_table::kPose, kBase, 1, {});
  CanFrame frame = good;
  frame.length = 7;
  EXPECT_EQ(decode(can_table::kPose, kBase, frame).status(), Status::checksum);
  frame = good;
  frame.extended = true;
  EXPECT_EQ(decode(can_table::kPose, kBase, frame).status(), Status::invalid_argument);
  frame = good;
  frame.remote = true;
  EXPECT_EQ(decode(can_table::kPose, kBase, frame).status(), Status::invalid_argument);
  frame = good;
  frame.data[1] = 0x0F;  // profile 1 knows no counter 15
  frame.data[0] = frame_crc(can_layout::kPose, frame.data);
  EXPECT_EQ(decode(can_table::kPose, kBase, frame).status(), Status::checksum);
}

TEST(CanCodec, WhatIsNoNumberOrTooLargeSaysNotAvailable) {
  const CanSignal& x = can_table::kPoseSignals[0];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(to_raw(x, 524.286), 262'143);
  for (const double value : {524.288, -524.288, 1e300, -1e300, nan}) {
    EXPECT_EQ(to_raw(x, value), x.not_available()) << value;
  }
  EXPECT_TRUE(std::isnan(to_value(x, x.not_available())));
  const CanSignal& age = can_table::kHealthSignals[4];
  EXPECT_EQ(to_raw(age, 2.54), 254);
  EXPECT_EQ(to_raw(age, 2.55), 255);
  EXPECT_EQ(to_raw(age, -0.01), 255) << "below the range is not available either";
  EXPECT_EQ(to_raw(age, nan), 255);
}

TEST(FramesOut, ACovarianceThatIsNoNumberDoesNotLookLikeCertainty) {
  PoseEstimate estimate;
  estimate.match_covariance =
      Matrix3f::diagonal(std::numeric_limits<float>::quiet_NaN(), -1.0F, 0.04F);
  FramesOut frames{kBase};
  const auto sigma = decode(can_table::kMatchSigma, kBase, frames.match_sigma(estimate));
  ASSERT_TRUE(sigma);
  EXPECT_EQ(sigma->raw[0], 0x1FFFF);
  EXPECT_EQ(sigma->raw[1], 0x1FFFF);
  EXPECT_EQ(sigma->raw[2], 2000);
  const auto correlation = decode(can_table::kCorrelation, kBase, frames.correlation(estimate));
  ASSERT_TRUE(correlation);
  EXPECT_EQ(correlation->raw[0], -128);
  const auto health =
      decode(can_table::kHealth, kBase, frames.health(estimate, OperatingMode::mapping, {}));
  ASSERT_TRUE(health);
  EXPECT_EQ(health->raw[5], 8191);
  EXPECT_EQ(health->raw[6], 1000);
}

TEST(FramesOut, CovarianceTwistTimeAndEventsAreTold) {
  PoseEstimate estimate;
  estimate.stamp = Timestamp{123'456'789us};
  estimate.base_twist = {.x_mps = 0.5F, .y_mps = -0.01F, .omega_radps = -1.25F};
  estimate.match_covariance = Matrix3f::diagonal(4e-4F, 9e-4F, 1e-4F);
  estimate.match_covariance(0, 1) = estimate.match_covariance(1, 0) = 3e-4F;
  FramesOut frames{kBase};
  const auto twist = decode(can_table::kTwist, kBase, frames.twist(estimate));
  EXPECT_EQ(twist->raw, (std::array<std::int64_t, 8>{5000, -100, -12500}));
  EXPECT_EQ(decode(can_table::kTime, kBase, frames.time(estimate))->raw[0], 123'456'789);
  EXPECT_EQ(decode(can_table::kMatchSigma, kBase, frames.match_sigma(estimate))->raw,
            (std::array<std::int64_t, 8>{200, 300, 100}));
  EXPECT_EQ(decode(can_table::kCorrelation, kBase, frames.correlation(estimate))->raw[0], 50);
  const Event event{.stamp_us = 5'000'900,
                    .argument = -7,
                    .code = EventCode::pose_jump,
                    .from = HealthState::tracking,
                    .to = HealthState::degraded,
                    .reason = HealthReason::overrun};
  EXPECT_EQ(decode(can_table::kEvent, kBase, frames.event(event, 65'537))->raw,
            (std::array<std::int64_t, 8>{1, 7, 1, 2, 11, -7}));
  EXPECT_EQ(decode(can_table::kEventTime, kBase, frames.event_time(event, 65'537))->raw,
            (std::array<std::int64_t, 8>{1, 5000}));
}

TEST(FramesOut, CountersRunFrom0To14EachOnItsOwn) {
  FramesOut frames{kBase};
  for (int i = 0; i < 40; ++i) {
    const auto pose = decode(can_table::kPose, kBase, frames.pose({}));
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->counter, i % 15);
  }
  EXPECT_EQ(decode(can_table::kTwist, kBase, frames.twist({}))->counter, 0);
}

TEST(CommandGate, TicksAndCountersDecide) {
  CommandGate gate{kBase};
  Timestamp now{100s};
  const auto send = [&](std::uint8_t counter, std::uint8_t tick) {
    const Command command{.kind = CommandKind::set_mode, .counter = counter, .tick = tick};
    return gate.check(encode_command(kBase, command), now)->verdict;
  };
  const std::uint8_t tick = can_tick(now);
  EXPECT_EQ(tick, 400 % 256);
  EXPECT_EQ(send(9, static_cast<std::uint8_t>(tick - 2)), CommandResult::done);
  EXPECT_EQ(send(10, static_cast<std::uint8_t>(tick - 3)), CommandResult::stale);
  EXPECT_EQ(send(10, static_cast<std::uint8_t>(tick + 1)), CommandResult::stale) << "of the future";
  EXPECT_EQ(send(9, tick), CommandResult::repeated);
  EXPECT_EQ(send(1, tick), CommandResult::done) << "7 ahead of 9, round the corner";
  EXPECT_EQ(send(0, tick), CommandResult::stale) << "behind";
  now += 1s;
  EXPECT_EQ(send(1, can_tick(now)), CommandResult::done) << "forgotten";
  EXPECT_EQ(gate.check(encode(can_table::kPose, kBase, 0, {}), now).status(), Status::not_ready);
}

}  // namespace
}  // namespace picolo
