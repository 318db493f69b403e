// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// The simulated IMU in the bytes of others.
#include <bit>
#include <cmath>

#include "dialect.hpp"
#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/drivers/witmotion/witmotion_group.hpp"

namespace picolo::inline v0::devices {
namespace {

class ImuDialect : public Dialect {
 public:
  using Dialect::Dialect;

 protected:
  virtual void sample(const ImuSample& sample, Timestamp stamp) = 0;

 private:
  void translate(std::uint8_t byte, const ByteTime& time) override {
    if (!is_ok(decoder_.push(byte))) { return; }
    const auto found =
        group_.add(decoder_.frame(), time.first_bit(kWitMotionFrameSize),
                   transmission_time(kWitMotionFrameSize, time.baud), StampSource::hardware);
    if (found) { sample(*found, time.arrived); }
  }
  WitMotionDecoder decoder_{};
  WitMotionGroup group_{};
};

void add_float(Bytes& bytes, float value, bool big_endian) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned i = 0; i < 4; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(bits >> (big_endian ? 24 - 8 * i : 8 * i)));
  }
}

class XsensDialect final : public ImuDialect {
 public:
  using ImuDialect::ImuDialect;

 private:
  void sample(const ImuSample& sample, Timestamp stamp) override {
    const auto time_100us = static_cast<std::uint32_t>(sample.stamp.time_since_epoch() / 100us);
    Bytes bytes{0xFA,
                0xFF,
                0x36,
                0,
                0x10,
                0x20,
                2,
                static_cast<std::uint8_t>(counter_ >> 8U),
                static_cast<std::uint8_t>(counter_ & 0xFFU),
                0x10,
                0x60,
                4};
    ++counter_;
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<std::uint8_t>(time_100us >> shift));
    }
    bytes.insert(bytes.end(), {0x40, 0x20, 12});
    for (const float value : sample.acceleration_mps2) { add_float(bytes, value, true); }
    bytes.insert(bytes.end(), {0x80, 0x20, 12});
    for (const float value : sample.rate_radps) { add_float(bytes, value, true); }
    bytes[3] = static_cast<std::uint8_t>(bytes.size() - 4);
    const std::uint8_t sum = sum8(ByteView{bytes}.subspan(1));
    bytes.push_back(static_cast<std::uint8_t>(0U - sum));
    say(bytes, stamp);
  }
  std::uint16_t counter_ = 0;
};

class VectornavDialect final : public ImuDialect {
 public:
  using ImuDialect::ImuDialect;

 private:
  void sample(const ImuSample& sample, Timestamp stamp) override {
    Bytes bytes{0xFA, 0x01, 0x21, 0x01};
    const auto time_ns =
        static_cast<std::uint64_t>(sample.stamp.time_since_epoch().count()) * 1000U;
    for (unsigned i = 0; i < 8; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(time_ns >> (8 * i)));
    }
    for (const float value : sample.rate_radps) { add_float(bytes, value, false); }
    for (const float value : sample.acceleration_mps2) { add_float(bytes, value, false); }
    const std::uint16_t crc = crc16_ccitt(ByteView{bytes}.subspan(1));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
    bytes.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    say(bytes, stamp);
  }
};

class Bno08xDialect final : public ImuDialect {
 public:
  using ImuDialect::ImuDialect;

 private:
  void sample(const ImuSample& sample, Timestamp stamp) override {
    constexpr double kCdegPerRad = 5729.577951308232;
    yaw_cdeg_ = std::remainder(
        yaw_cdeg_ + static_cast<double>(sample.rate_radps[2]) * kCdegPerRad * 0.01, 36'000.0);
    Bytes bytes{0xAA, 0xAA, index_++};
    add_u16(bytes, word(yaw_cdeg_));
    add_u16(bytes, 0);
    add_u16(bytes, 0);
    for (const float value : sample.acceleration_mps2) {
      add_u16(bytes, word(static_cast<double>(value) / 0.00980665));
    }
    bytes.resize(18);
    bytes.push_back(sum8(ByteView{bytes}.subspan(2)));
    say(bytes, stamp);
  }
  static std::uint16_t word(double value) {
    return static_cast<std::uint16_t>(
        static_cast<std::int16_t>(std::lround(std::fmin(std::fmax(value, -32'767.0), 32'767.0))));
  }
  double yaw_cdeg_ = 0.0;
  std::uint8_t index_ = 0;
};

}  // namespace

SerialPortPointer make_imu_dialect(const std::string& name, SerialPort& witmotion) {
  if (name == "witmotion") { return make_port<PassingLine>(witmotion); }
  if (name == "xsens") { return make_port<XsensDialect>(witmotion); }
  if (name == "vectornav") { return make_port<VectornavDialect>(witmotion); }
  if (name == "bno08x-rvc") { return make_port<Bno08xDialect>(witmotion); }
  refuse_dialect(name);
}

}  // namespace picolo::inline v0::devices
