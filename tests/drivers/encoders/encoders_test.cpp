// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// ODrive, VESC and DBC signals, against published frames and recordings.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "picolo/devices/candump.hpp"
#include "picolo/devices/dbc_file.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/dbc/dbc_wheels.hpp"
#include "picolo/drivers/odrive/odrive_wheels.hpp"
#include "picolo/drivers/vesc/vesc_wheels.hpp"
#include "support/fake_can_bus.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

ByteView data_of(const CanFrame& frame) {
  return ByteView{frame.data}.first(frame.length);
}

nlohmann::json json_of(const char* name) {
  std::ifstream file{data_path(name)};
  return nlohmann::json::parse(file);
}

CanFrame estimates(std::uint32_t node, Timestamp stamp, float turns, float rate) {
  CanFrame frame{
      .stamp = stamp, .id = odrive_id(node, OdriveCommand::encoder_estimates), .length = 8};
  store_u32_le(frame.data, 0, std::bit_cast<std::uint32_t>(turns));
  store_u32_le(frame.data, 4, std::bit_cast<std::uint32_t>(rate));
  return frame;
}

TEST(Odrive, GivenEstimatesOfTwoAxesThenTicksFollowAndNonsenseIsCounted) {
  FakeCanBus bus;
  OdriveWheels wheels{bus, {.wheels = {{{.node = 3}, {.node = 5, .inverted = true}}}}};
  std::int64_t left = 0;
  std::int64_t right = 0;
  int samples = 0;
  for (int i = 0; i <= 100; ++i) {
    const Timestamp now = Timestamp{1s} + i * 10ms;
    EXPECT_TRUE(wheels.consume(can_frame(now, 0x061, {0, 0, 0, 0, 8, 0, 0, 0})));
    EXPECT_TRUE(wheels.consume(can_frame(now, 0x0A1, {0, 0, 0, 0, 8, 0, 0, 0})));
    EXPECT_TRUE(wheels.consume(estimates(3, now, 10.0F + 0.25F * static_cast<float>(i), 25.0F)));
    EXPECT_TRUE(wheels.consume(estimates(5, now + 1ms, -0.5F * static_cast<float>(i), -50.0F)));
    const auto sample = wheels.take();
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->restarted, i == 0);
    left = sample->ticks[0];
    right = sample->ticks[1];
    ++samples;
  }
  EXPECT_EQ(left, 25 * 4096);
  EXPECT_EQ(right, 50 * 4096);
  EXPECT_TRUE(wheels.healthy());
  EXPECT_TRUE(wheels.consume(estimates(3, Timestamp{3s}, std::nanf(""), 0.0F)));
  EXPECT_TRUE(wheels.consume(can_frame(Timestamp{3s}, 0x069, {1, 2, 3})));
  EXPECT_FALSE(wheels.consume(can_frame(Timestamp{3s}, 0x181, {1, 2, 3})));
  EXPECT_EQ(wheels.counters().damaged, 1U);
  EXPECT_EQ(wheels.counters().short_frames, 1U);
  // Axis error 0, and faulted all the same.
  EXPECT_TRUE(wheels.consume(can_frame(Timestamp{3s}, 0x061, {0, 0, 0, 0, 1, 0, 1, 0})));
  EXPECT_FALSE(wheels.healthy());
}

TEST(Odrive, GivenSilenceThenTheNextPositionIsABaseAndCountsAreRequested) {
  FakeCanBus bus;
  OdriveWheels wheels{bus, {.position = OdrivePosition::counts}};
  auto counts = [](std::uint32_t node, Timestamp stamp, std::uint32_t value) {
    CanFrame frame{
        .stamp = stamp, .id = odrive_id(node, OdriveCommand::encoder_count), .length = 8};
    store_u32_le(frame.data, 0, value);
    return frame;
  };
  EXPECT_EQ(wheels.service(Timestamp{1s}), Status::ok);
  ASSERT_EQ(bus.sent().size(), 2U);
  EXPECT_TRUE(bus.sent()[0].remote);
  for (std::uint32_t node = 0; node < 2; ++node) {
    wheels.consume(
        can_frame(Timestamp{1s}, odrive_id(node, OdriveCommand::heartbeat), {0, 0, 0, 0, 8}));
    wheels.consume(counts(node, Timestamp{1s}, 0x7FFFFFF0U));
  }
  EXPECT_TRUE(wheels.take());
  for (std::uint32_t node = 0; node < 2; ++node) {
    wheels.consume(counts(node, Timestamp{1s} + 10ms, 0x80000010U));
  }
  EXPECT_EQ(wheels.take()->ticks[0], 32);
  EXPECT_EQ(wheels.service(Timestamp{2s}), Status::ok);
  EXPECT_EQ(wheels.counters().losses, 2U);
  EXPECT_FALSE(wheels.healthy());
  for (std::uint32_t node = 0; node < 2; ++node) {
    wheels.consume(
        can_frame(Timestamp{3s}, odrive_id(node, OdriveCommand::heartbeat), {0, 0, 0, 0, 8}));
    wheels.consume(counts(node, Timestamp{3s}, 100));
  }
  const auto sample = wheels.take();
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->restarted);
  EXPECT_EQ(sample->ticks[0], 32);
}

TEST(Vesc, GivenPublishedFramesThenTheirFieldsAreRead) {
  PICOLO_NEED_DATA("drivers/can/vesc_vectors.json");
  const auto vectors = json_of("drivers/can/vesc_vectors.json");
  const CanFrame current = parse_can_frame(vectors.at(0).at("frame"));
  EXPECT_EQ(current.id, vesc_id(23, VescCommand::set_current));
  EXPECT_EQ(load_i32_be(current.data, 0), 51'000);
  const CanFrame status = parse_can_frame(vectors.at(1).at("frame"));
  EXPECT_EQ(status.id, vesc_id(1, VescCommand::status));
  EXPECT_EQ(decode_vesc_status(data_of(status))->erpm, 300);
  const CanFrame status5 = parse_can_frame(vectors.at(2).at("frame"));
  EXPECT_EQ(status5.id, vesc_id(1, VescCommand::status_5));
  EXPECT_EQ(decode_vesc_status_5(data_of(status5))->tachometer, 100);
  EXPECT_EQ(decode_vesc_status_5(data_of(status5))->input_dv, 240);
  EXPECT_TRUE(decode_vesc_status_5(data_of(status5).first(6)));
  EXPECT_FALSE(decode_vesc_status_5(data_of(status5).first(5)));
  EXPECT_EQ(vesc_id(7, VescCommand::status_6), 0x3A07U);
}

TEST(Vesc, GivenTachometersThatWrapThenTicksFollowAndSilenceIsNoticed) {
  VescWheels wheels{{.wheels = {{{.vesc = 10}, {.vesc = 11, .inverted = true}}}}};
  auto tachometer = [](std::uint8_t vesc, Timestamp stamp, std::uint32_t value) {
    CanFrame frame{
        .stamp = stamp, .id = vesc_id(vesc, VescCommand::status_5), .extended = true, .length = 8};
    for (std::size_t i = 0; i < 4; ++i) {
      frame.data.at(i) = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
    return frame;
  };
  std::array<std::int64_t, 2> ticks{};
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Timestamp now = Timestamp{1s} + i * 20ms;
    EXPECT_TRUE(wheels.consume(tachometer(10, now, 0x7FFFFFFFU + 42 * i)));
    EXPECT_TRUE(wheels.consume(tachometer(11, now + 3ms, 1000 - 21 * i)));
    const auto sample = wheels.take();
    ASSERT_TRUE(sample);
    ticks = {sample->ticks[0], sample->ticks[1]};
  }
  EXPECT_EQ(ticks[0], 49 * 42);
  EXPECT_EQ(ticks[1], 49 * 21);
  EXPECT_TRUE(wheels.healthy());
  EXPECT_EQ(wheels.service(Timestamp{4s}), Status::ok);
  EXPECT_FALSE(wheels.healthy());
  EXPECT_EQ(wheels.counters().losses, 2U);
}

TEST(DbcSignals, GivenTheTortureCasesThenBitsAreWhereTheyBelong) {
  // Honda's 15 bits across bytes, Hyundai's 14 bits little-endian, one bit, all 64.
  const std::array<std::uint8_t, 8> data{0x12, 0x35, 0x56, 0x78, 0x9A, 0xBC, 0xDE, 0xF1};
  auto raw = [&data](std::uint8_t start, std::uint8_t length, bool big) {
    return *dbc_raw({.start_bit = start, .length = length, .big_endian = big}, data);
  };
  EXPECT_EQ(raw(7, 16, true), 0x1235U);
  EXPECT_EQ(raw(8, 15, true), (0x1U << 14U) | (0x56U << 6U) | (0x78U >> 2U));
  EXPECT_EQ(raw(0, 14, false), 0x3512U & 0x3FFFU);
  EXPECT_EQ(raw(18, 14, false), (0x7856U >> 2U) & 0x3FFFU);
  EXPECT_EQ(raw(63, 1, true), 1U);
  EXPECT_EQ(raw(0, 64, false), 0xF1DEBC9A78563512ULL);
  EXPECT_EQ(raw(7, 64, true), 0x123556789ABCDEF1ULL);
  EXPECT_FALSE((DbcSignal{.start_bit = 60, .length = 8}.valid(8)));
  EXPECT_FALSE((DbcSignal{.start_bit = 7, .length = 17, .big_endian = true}.valid(2)));
  EXPECT_EQ(dbc_integer({.start_bit = 56, .length = 8, .type = DbcType::signed_integer}, data)
                .value_or(0),
            -15);
}

TEST(DbcFiles, GivenTheRecordedLeafThenEveryFrameDecodesAsPublished) {
  PICOLO_NEED_DATA("drivers/can/nissan_leaf_2018.dbc");
  const devices::DbcFile file =
      devices::read_dbc(data_path("drivers/can/nissan_leaf_2018.dbc").string());
  EXPECT_TRUE(file.problems.empty()) << file.problems.front();
  int signals = 0;
  for (const auto& entry : json_of("drivers/can/leaf_decoded.json")) {
    const auto id =
        static_cast<std::uint32_t>(std::stoul(entry.at("id").get<std::string>(), nullptr, 16));
    const Bytes data = from_hex(entry.at("data").get<std::string>());
    const devices::DbcFileMessage* message = file.find(id, false);
    ASSERT_NE(message, nullptr) << id;
    for (const auto& [name, expected] : entry.at("decoded").items()) {
      bool found = false;
      for (const devices::DbcFileSignal& signal : message->signals) {
        if (signal.name != name) { continue; }
        found = true;
        const auto value = devices::dbc_value(*message, signal, data);
        ASSERT_TRUE(value) << name;
        EXPECT_DOUBLE_EQ(*value, expected.get<double>()) << name;
        ++signals;
      }
      EXPECT_TRUE(found) << name;
    }
  }
  EXPECT_GT(signals, 1000);
}

TEST(DbcFiles, GivenOtherDatabasesThenFloatsAreFloatsAndDamageIsNamed) {
  PICOLO_NEED_DATA("drivers/can/odrive-cansimple-0.5.6.dbc");
  const devices::DbcFile odrive =
      devices::read_dbc(data_path("drivers/can/odrive-cansimple-0.5.6.dbc").string());
  const devices::DbcFileMessage* message = odrive.find(9, false);
  ASSERT_NE(message, nullptr);
  for (const devices::DbcFileSignal& signal : message->signals) {
    EXPECT_EQ(signal.bits.type, DbcType::float32) << signal.name;
  }
  EXPECT_GT(devices::read_dbc(data_path("drivers/can/ThinkCity.dbc").string()).messages.size(),
            100U);

  const std::string text{
      "BO_ 1078 SHORT: 2 X\n SG_ PAST : 7|24@0+ (1,0) [0|1] \"\" X\n SG_ FINE : 7|16@0- (1,0) "
      "[0|1] "
      "\"u\" X\n SG_ BROKEN 7|16\n"};
  const devices::DbcFile bad = devices::parse_dbc(text, "bad.dbc");
  ASSERT_EQ(bad.problems.size(), 2U);
  EXPECT_NE(bad.problems[1].find("bad.dbc:2: SHORT.PAST lies past the end"), std::string::npos);
  EXPECT_THROW(static_cast<void>(devices::dbc_wheel(bad, "SHORT.PAST")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(devices::dbc_wheel(bad, "SHORT.NONE")), std::invalid_argument);
  EXPECT_TRUE(devices::dbc_wheel(bad, "SHORT.FINE").valid());
}

TEST(DbcWheels, GivenTheCommaBodysAnglesThenTicksFollowOverTheirWrap) {
  PICOLO_NEED_DATA("drivers/can/comma_body.dbc");
  const devices::DbcFile file = devices::read_dbc(data_path("drivers/can/comma_body.dbc").string());
  DbcWheelsConfig config;
  config.wheels[0] = devices::dbc_wheel(file, "MOTORS_ANGLE.LEFT_ANGLE_SENSOR");
  config.wheels[1] = devices::dbc_wheel(file, "MOTORS_ANGLE.RIGHT_ANGLE_SENSOR");
  for (std::size_t i = 0; i < 2; ++i) { config.wheels[i].counter.modulus = 16'384; }
  ASSERT_TRUE(config.valid());
  DbcWheels wheels{config};
  std::int64_t left = 0;
  for (unsigned i = 0; i < 100; ++i) {
    const unsigned a = (16'000 + 50 * i) % 16'384;
    const unsigned b = (100 + 16'384 * 4 - 30 * i) % 16'384;
    EXPECT_TRUE(wheels.consume(can_frame(
        Timestamp{i * 10ms}, 0x205,
        {static_cast<std::uint8_t>(a >> 8), static_cast<std::uint8_t>(a & 0xFF),
         static_cast<std::uint8_t>(b >> 8), static_cast<std::uint8_t>(b & 0xFF), 0, 0, 0, 0})));
    const auto sample = wheels.take();
    ASSERT_TRUE(sample);
    left = sample->ticks[0];
    EXPECT_EQ(sample->ticks[1], -30 * static_cast<int>(i));
  }
  EXPECT_EQ(left, 99 * 50);
}

TEST(DbcWheels, GivenTheLeafsWheelSpeedsThenChecksumAndCounterHoldInTheWholeRecording) {
  PICOLO_NEED_DATA("drivers/can/test_nissan_leaf_traffic.candump");
  const devices::DbcFile file =
      devices::read_dbc(data_path("drivers/can/nissan_leaf_2018.dbc").string());
  DbcWheelsConfig config;
  const char* names[]{"WHEEL_SPEEDS_FRONT.WHEEL_SPEED_FL", "WHEEL_SPEEDS_FRONT.WHEEL_SPEED_FR"};
  for (std::size_t i = 0; i < 2; ++i) {
    config.wheels[i] = devices::dbc_wheel(file, names[i]);
    config.wheels[i].quantity = DbcQuantity::speed;
    config.wheels[i].rules = {.checksum = DbcChecksum::sum_with_id,
                              .checksum_byte = 7,
                              .counter = {.start_bit = 48, .length = 8}};
  }
  DbcWheels wheels{config};
  std::ifstream log{data_path("drivers/can/test_nissan_leaf_traffic.candump")};
  for (std::string line; std::getline(log, line);) {
    const auto frame = devices::parse_candump(line);
    ASSERT_TRUE(frame) << line;
    wheels.consume(*frame);
  }
  EXPECT_GT(wheels.counters().frames, 200U);
  EXPECT_EQ(wheels.counters().damaged, 0U);
  CanFrame broken = can_frame(Timestamp{1s}, 0x284, {0, 0, 0, 0, 0, 0, 0x7F, 0x06});
  EXPECT_TRUE(wheels.consume(broken));
  EXPECT_EQ(wheels.counters().damaged, 1U);
}

}  // namespace
}  // namespace picolo::test
