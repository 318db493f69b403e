// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// BNO08x RVC, Xsens and VectorNav against published bytes, and their clocks, gaps and saturation.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "picolo/core/crc.hpp"
#include "picolo/drivers/bno08x/bno08x_rvc.hpp"
#include "picolo/drivers/common/axis_watch.hpp"
#include "picolo/drivers/common/wire_float.hpp"
#include "picolo/drivers/vectornav/vectornav.hpp"
#include "picolo/drivers/xsens/xsens.hpp"
#include "support/bytes.hpp"
#include "support/fake_serial_port.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

template <typename Protocol>
std::vector<ImuSample> decode(Protocol& protocol, const Bytes& stream, Timestamp start = {},
                              std::uint32_t baud = 115'200) {
  std::array<ImuSample, Protocol::kMaxSamplesPerByte> out{};
  std::vector<ImuSample> samples;
  std::size_t position = 0;
  for (const std::uint8_t byte : stream) {
    const ByteTime time{.arrived = start + transmission_time(++position, baud), .baud = baud};
    const std::size_t count = protocol.push(byte, time, out);
    samples.insert(samples.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return samples;
}

Bytes rvc_frame(unsigned index, int yaw_cdeg, int ax_mg) {
  Bytes bytes(19);
  bytes[0] = 0xAA;
  bytes[1] = 0xAA;
  bytes[2] = static_cast<std::uint8_t>(index);
  store_u16_le(bytes, 3, static_cast<std::uint16_t>(yaw_cdeg));
  store_u16_le(bytes, 9, static_cast<std::uint16_t>(ax_mg));
  store_u16_le(bytes, 13, 1000);
  bytes[18] = sum8(std::span<const std::uint8_t>{bytes}.subspan(2, 16));
  return bytes;
}

TEST(Bno08xRvc, GivenThePublishedFrameThenItsFieldsAreRead) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("BNO08x UART-RVC");
  ASSERT_EQ(vectors.size(), 1U);
  Bno08xRvcProtocol protocol;
  EXPECT_TRUE(decode(protocol, vectors[0].bytes).empty());  // a rate needs two headings
  ASSERT_TRUE(protocol.frame_ready());
  const auto& expected = vectors[0].expected;
  EXPECT_EQ(protocol.frame().index, expected.at("index").get<int>());
  EXPECT_NEAR(protocol.frame().yaw_cdeg, 100 * expected.at("yaw_deg").get<double>(), 1e-6);
  EXPECT_NEAR(protocol.frame().pitch_cdeg, 100 * expected.at("pitch_deg").get<double>(), 1e-6);
  EXPECT_NEAR(protocol.frame().roll_cdeg, 100 * expected.at("roll_deg").get<double>(), 1e-6);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(protocol.frame().acceleration_mg.at(i), expected.at("accel_mg").at(i).get<int>());
  }
}

TEST(Bno08xRvc, GivenATurnOverTheWrapsThenTheRateIsSteadyAndGapsAreDivided) {
  Bno08xRvcProtocol protocol;
  Bytes stream;
  for (unsigned i = 0; i < 600; ++i) {
    if (i % 50 == 7) { continue; }  // lost
    const int yaw = (static_cast<int>(i) * 100 + 18'000) % 36'000 - 18'000;
    const Bytes frame = rvc_frame(i & 0xFFU, yaw, i == 300 ? 8000 : 20);
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  const auto samples = decode(protocol, stream);
  ASSERT_EQ(samples.size(), 600U - 12U - 1U);
  for (const ImuSample& sample : samples) {
    EXPECT_NEAR(sample.rate_radps[2], 100 * std::numbers::pi / 180, 1e-4);
  }
  EXPECT_EQ(protocol.counters().missed, 12U);
  EXPECT_EQ(protocol.counters().saturated, 1U);
}

TEST(Bno08xRvc, GivenAnIndexThatLooksLikeAHeaderThenTheFrameIsFound) {
  Bno08xRvcProtocol protocol;
  const Bytes stream = join({{0xAA}, rvc_frame(0xAA, 5, 0), rvc_frame(0xAB, 10, 0)});
  EXPECT_EQ(decode(protocol, stream).size(), 1U);
}

TEST(Xsens, GivenPublishedMessagesThenTheirItemsAreRead) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("Xsens MTData2");
  ASSERT_EQ(vectors.size(), 2U);
  for (const ByteVector& vector : vectors) {
    SCOPED_TRACE(vector.id);
    XsensProtocol protocol;
    decode(protocol, vector.bytes);
    ASSERT_TRUE(protocol.data_ready());
    for (const auto& item : vector.expected.at("items")) {
      const auto xdi = item.at("xdi").get<std::string>();
      const auto& value = item.at("value");
      if (xdi == "0x1060") {
        EXPECT_EQ(protocol.data().sample_time_100us, value.get<std::uint32_t>());
        continue;
      }
      const auto& axes = xdi == "0x2030" ? protocol.data().euler_deg : protocol.data().rate_radps;
      ASSERT_TRUE(axes.has_value());
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_FLOAT_EQ(axes->at(i), value.at(i).get<float>());
      }
    }
  }
}

void append_item(Bytes& data, unsigned identifier, const Bytes& item) {
  data.push_back(static_cast<std::uint8_t>(identifier >> 8U));
  data.push_back(static_cast<std::uint8_t>(identifier & 0xFFU));
  data.push_back(static_cast<std::uint8_t>(item.size()));
  data.insert(data.end(), item.begin(), item.end());
}

Bytes big_endian(std::uint64_t value, std::size_t size) {
  Bytes bytes;
  for (std::size_t i = size; i > 0; --i) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * (i - 1))));
  }
  return bytes;
}

Bytes xsens_message(const Bytes& data) {
  Bytes bytes{0xFA, 0xFF, 0x36};
  if (data.size() >= 255) {
    bytes = join({bytes, {0xFF}, big_endian(data.size(), 2)});
  } else {
    bytes.push_back(static_cast<std::uint8_t>(data.size()));
  }
  bytes.insert(bytes.end(), data.begin(), data.end());
  const std::uint8_t sum = sum8(std::span<const std::uint8_t>{bytes}.subspan(1));
  bytes.push_back(static_cast<std::uint8_t>(0U - sum));
  return bytes;
}

Bytes vector_of(float x, float y, float z) {
  return join({big_endian(std::bit_cast<std::uint32_t>(x), 4),
               big_endian(std::bit_cast<std::uint32_t>(y), 4),
               big_endian(std::bit_cast<std::uint32_t>(z), 4)});
}

Bytes imu_message(std::uint32_t index, float rate, std::uint32_t status = 0) {
  Bytes data;
  append_item(data, 0x1020, big_endian(index & 0xFFFFU, 2));
  append_item(data, 0x1060, big_endian((0xFFFFFF00U + index * 100U) & 0xFFFFFFFFU, 4));
  append_item(data, 0x4020, vector_of(0.1F, 0.2F, 9.8F));
  append_item(data, 0x8020, vector_of(0.0F, 0.0F, rate));
  append_item(data, 0xE020, big_endian(status, 4));
  return xsens_message(data);
}

TEST(Xsens, GivenTheFourNumberFormatsThenTheValueIsTheSame) {
  const double value = -1.5703125;
  const std::vector<std::pair<unsigned, Bytes>> formats{
      {0x8020, big_endian(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4)},
      {0x8021, big_endian(static_cast<std::uint64_t>(std::llround(value * 1048576)), 4)},
      {0x8022,
       join({big_endian(static_cast<std::uint64_t>(std::llround((value + 2) * 4294967296.0)), 4),
             big_endian(0xFFFE, 2)})},
      {0x8023, big_endian(std::bit_cast<std::uint64_t>(value), 8)}};
  for (const auto& [identifier, number] : formats) {
    Bytes data;
    append_item(data, identifier, join({number, number, number}));
    XsensProtocol protocol;
    const auto samples = decode(protocol, xsens_message(data));
    ASSERT_EQ(samples.size(), 1U) << identifier;
    EXPECT_FLOAT_EQ(samples[0].rate_radps[2], static_cast<float>(value)) << identifier;
  }
}

TEST(Xsens, GivenLateDeliveryThenTheDeviceClockTakesTheJitterAwayOverItsWraps) {
  XsensProtocol protocol;
  std::array<ImuSample, XsensProtocol::kMaxSamplesPerByte> out{};
  Timestamp last{};
  int count = 0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Duration late = i % 7 == 0 && i > 10 ? 9ms : 0ms;  // seven messages at once
    Timestamp arrived = Timestamp{1s} + i * 10ms + late;
    for (const std::uint8_t byte : imu_message(i + 65'000, i == 500 ? 40.0F : 0.5F)) {
      const ByteTime time{.arrived = arrived, .baud = 1'000'000};
      if (protocol.push(byte, time, out) == 0) { continue; }
      ++count;
      if (count > 20) { EXPECT_NEAR(to_seconds(out[0].stamp - last), 0.010, 0.0006) << i; }
      EXPECT_EQ(out[0].saturated, i == 500);
      EXPECT_EQ(out[0].source, StampSource::device);
      last = out[0].stamp;
    }
  }
  EXPECT_EQ(count, 1000);
  EXPECT_EQ(protocol.counters().missed, 0U);
  EXPECT_EQ(protocol.counters().clock_restarts, 0U);
}

TEST(Xsens, GivenLongMessagesGapsAndClippingThenTheyAreCounted) {
  Bytes filler;
  for (int i = 0; i < 20; ++i) { append_item(filler, 0x5040, Bytes(17, 0xFA)); }
  append_item(filler, 0x8020, vector_of(1.0F, 2.0F, 3.0F));
  XsensProtocol protocol;
  const auto samples =
      decode(protocol,
             join({xsens_message(filler), imu_message(5, 0.1F), imu_message(9, 0.1F, 1U << 12U)}));
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_FLOAT_EQ(samples[0].rate_radps[1], 2.0F);
  EXPECT_EQ(protocol.counters().missed, 3U);
  EXPECT_EQ(protocol.counters().saturated, 1U);
}

TEST(Vectornav, GivenThePublishedLineThenItsNumbersAreRead) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("VectorNav ASCII");
  ASSERT_EQ(vectors.size(), 1U);
  VectornavProtocol protocol;
  const auto samples = decode(protocol, vectors[0].bytes);
  ASSERT_EQ(samples.size(), 1U);
  const auto& expected = vectors[0].expected;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(samples[0].acceleration_mps2.at(i),
                    expected.at("accel_mps2").at(i).get<float>());
    EXPECT_FLOAT_EQ(samples[0].rate_radps.at(i), expected.at("gyro_rps").at(i).get<float>());
  }
}

Bytes vn_binary(float rate, std::uint64_t time_ns) {
  // Common group: TimeStartup, AngularRate, Accel.
  Bytes bytes{0xFA, 0x01, 0x21, 0x01};
  for (std::size_t i = 0; i < 8; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(time_ns >> (8 * i)));
  }
  for (const float value : {0.0F, 0.0F, rate, 0.0F, 0.1F, -9.8F}) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned i = 0; i < 4; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
    }
  }
  const std::uint16_t crc = crc16_ccitt(std::span<const std::uint8_t>{bytes}.subspan(1));
  return join({bytes, big_endian(crc, 2)});
}

TEST(Vectornav, GivenBinaryAndTextMixedThenBothAreSamplesAndNanIsNone) {
  const std::string text{
      "$VNYMR,+100.949,+003.763,-004.353,+01.0538,-00.2531,+03.0614,+00.005,"
      "+00.344,-09.758,-00.001222,-00.000450,-00.001218*"};
  const Bytes body{text.begin() + 1, text.end() - 1};
  char sum[8];
  std::snprintf(sum, sizeof sum, "%02X\r\n", xor8(body));
  const std::string line = text + sum;
  VectornavProtocol protocol;
  const auto samples = decode(protocol, join({vn_binary(0.25F, 1'000'000),
                                              {line.begin(), line.end()},
                                              vn_binary(std::nanf(""), 2'000'000),
                                              vn_binary(36.0F, 3'000'000)}));
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_FLOAT_EQ(samples[0].rate_radps[2], 0.25F);
  EXPECT_FLOAT_EQ(samples[1].acceleration_mps2[2], -9.758F);
  EXPECT_TRUE(samples[2].saturated);
  EXPECT_EQ(protocol.counters().implausible, 1U);
}

TEST(AxisWatch, GivenADeadGyroBesideALivingAccelerometerThenItIsFoundAndItsReturnToo) {
  AxisWatch watch;
  for (int i = 0; i < 600; ++i) {
    ImuSample sample{.stamp = Timestamp{i * 10ms}};
    sample.acceleration_mps2 = {0.001F * static_cast<float>(i % 7), 0.0F, 9.8F};
    const bool dead = i >= 100 && i < 500;
    sample.rate_radps = {0.0F, 0.0F, dead ? 0.0F : 0.001F * static_cast<float>(1 + i % 3)};
    watch.update(sample);
    if (i < 290) { EXPECT_FALSE(watch.gyro_stuck()) << i; }
    if (i >= 305 && i < 500) { EXPECT_TRUE(watch.gyro_stuck()) << i; }
    if (i >= 501) { EXPECT_FALSE(watch.gyro_stuck()) << i; }
  }
  EXPECT_EQ(watch.events(), 1U);
  EXPECT_FALSE(watch.accelerometer_stuck());
}

TEST(WireFloat, GivenNumbersThenConversionsAreExactOrRefused) {
  for (const double value : {0.0, 1.0, -2.5, 1e-30, 3.3333333333, -123456.789, 1e38, 1e-50}) {
    EXPECT_EQ(*float_from_f64_bits(std::bit_cast<std::uint64_t>(value)), static_cast<float>(value));
  }
  EXPECT_EQ(float_from_f64_bits(std::bit_cast<std::uint64_t>(1e39)).status(), Status::corrupt);
  EXPECT_EQ(float_from_bits(0x7FC00000U).status(), Status::corrupt);
  for (const float value : {0.0F, 0.25F, -1.5F, 100'000.0078F, 3e-9F, -7e6F}) {
    EXPECT_EQ(*scaled_integer(std::bit_cast<std::uint32_t>(value), 4096),
              std::llround(static_cast<double>(value) * 4096.0));
  }
  EXPECT_EQ(scaled_integer(std::bit_cast<std::uint32_t>(1e30F), 4096).status(), Status::corrupt);
  const std::string text{"-00.044656"};
  EXPECT_FLOAT_EQ(*float_from_text(Bytes{text.begin(), text.end()}), -0.044656F);
  EXPECT_EQ(float_from_text(Bytes{'-', '.'}).status(), Status::corrupt);
}

}  // namespace
}  // namespace picolo::test
