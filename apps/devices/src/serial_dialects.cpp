// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/devices/dialects.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/common/serial_chunk.hpp"
#include "picolo/drivers/common/turn_cutter.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/drivers/witmotion/witmotion_group.hpp"

namespace picolo::inline v0::devices {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Reads the simulated device, hands each of its bytes to `translate`, and delivers what that says
/// with the same stamps.
class Dialect : public SerialPort {
 public:
  explicit Dialect(SerialPort& inner) : inner_(inner) {}
  virtual ~Dialect() = default;

  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    if (buffer.empty()) { return Status::not_ready; }
    while (pending_.empty()) {
      const Status status = chunk_.read(inner_, SerialChunk::kCapacity);
      if (!is_ok(status)) { return status; }
      for (std::size_t i = 0; i < chunk_.size(); ++i) { translate(chunk_[i], chunk_.time_of(i)); }
    }
    Burst& burst = pending_.front();
    const std::size_t size = std::min(buffer.size(), burst.bytes.size() - burst.taken);
    std::copy_n(burst.bytes.begin() + static_cast<std::ptrdiff_t>(burst.taken), size,
                buffer.begin());
    burst.taken += size;
    const std::size_t left = burst.bytes.size() - burst.taken;
    const SerialRead result{size, burst.stamp - transmission_time(left, baud()),
                            StampSource::hardware};
    if (left == 0) { pending_.pop_front(); }
    return result;
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) { obey(byte); }
    return bytes.size();
  }
  [[nodiscard]] std::uint32_t baud() const override { return 2 * inner_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return inner_.lost(); }

 protected:
  virtual void translate(std::uint8_t byte, const ByteTime& time) = 0;
  virtual void obey(std::uint8_t /*byte*/) {}
  void say(const Bytes& bytes, Timestamp stamp) {
    last_ = std::max(last_, stamp);
    pending_.push_back({bytes, last_, 0});
  }
  [[nodiscard]] Timestamp last() const { return last_; }

 private:
  struct Burst {
    Bytes bytes;
    Timestamp stamp{};
    std::size_t taken = 0;
  };
  SerialPort& inner_;
  SerialChunk chunk_{};
  std::deque<Burst> pending_;
  Timestamp last_{};
};

class Passing final : public Dialect {
 public:
  using Dialect::Dialect;

 private:
  void translate(std::uint8_t byte, const ByteTime& time) override { say({byte}, time.arrived); }
};

void add_u16(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>((value >> 8U) & 0xFFU));
}

// ---- lidars ---------------------------------------------------------------------------------

class LidarDialect : public Dialect {
 public:
  using Dialect::Dialect;

 protected:
  virtual void packet(const Ld06Packet& packet, Timestamp stamp) = 0;

 private:
  void translate(std::uint8_t byte, const ByteTime& time) override {
    if (is_ok(decoder_.push(byte))) { packet(decoder_.packet(), time.arrived); }
  }
  Ld06Decoder decoder_{};
};

std::uint32_t angle_q6(const Ld06Packet& packet, std::size_t point) {
  const std::uint32_t along = span_cdeg(packet) * static_cast<std::uint32_t>(point) / 11U;
  return (packet.start_cdeg + along) % kLd06FullTurnCdeg * 64U / 100U;
}

class RplidarDialect final : public LidarDialect {
 public:
  using LidarDialect::LidarDialect;

 private:
  void packet(const Ld06Packet& packet, Timestamp stamp) override {
    Bytes bytes;
    for (std::size_t i = 0; i < packet.points.size(); ++i) {
      const std::uint32_t angle = angle_q6(packet, i);
      const bool start = cutter_.passes_zero(angle);
      bytes.push_back(static_cast<std::uint8_t>((15U << 2U) | (start ? 1U : 2U)));
      add_u16(bytes, (angle << 1U) | 1U);
      add_u16(bytes, std::min<unsigned>(packet.points[i].distance_mm * 4U, 0xFFFFU));
    }
    if (scanning_) { say(bytes, stamp); }
    for (const Bytes& answer : answers_) { say(answer, stamp); }
    answers_.clear();
    scanning_ = scanning_ || starts_;
    starts_ = false;
  }

  void obey(std::uint8_t byte) override {
    const bool command = before_ == 0xA5;
    before_ = command ? std::uint8_t{0} : byte;
    if (!command) { return; }
    if (byte == 0x25) { scanning_ = false; }
    if (byte == 0x50) {
      Bytes answer{0xA5, 0x5A, 0x14, 0, 0, 0, 0x04, 0x18, 0, 1, 7};
      answer.resize(27);
      answers_.push_back(answer);
    }
    if (byte == 0x52) { answers_.push_back({0xA5, 0x5A, 0x03, 0, 0, 0, 0x06, 0, 0, 0}); }
    if (byte == 0x20) {
      answers_.push_back({0xA5, 0x5A, 0x05, 0, 0, 0x40, 0x81});
      starts_ = true;
    }
  }

  TurnCutter cutter_{360 * 64};
  std::vector<Bytes> answers_;
  std::uint8_t before_ = 0;
  bool scanning_ = false;
  bool starts_ = false;
};

class YdlidarDialect final : public LidarDialect {
 public:
  using LidarDialect::LidarDialect;

 private:
  void packet(const Ld06Packet& packet, Timestamp stamp) override {
    const unsigned first = (angle_q6(packet, 0) << 1U) | 1U;
    const unsigned last = (angle_q6(packet, 11) << 1U) | 1U;
    const unsigned head = 12U << 8U;
    unsigned sum = 0x55AAU ^ head ^ first ^ last;
    Bytes samples;
    for (const Ld06Point& point : packet.points) {
      const unsigned raw = std::min<unsigned>(point.distance_mm, 16'383U) << 2U;
      samples.push_back(point.intensity);
      add_u16(samples, raw);
      sum ^= point.intensity ^ raw;
    }
    Bytes bytes;
    for (const unsigned word : {0x55AAU, head, first, last, sum}) { add_u16(bytes, word); }
    bytes.insert(bytes.end(), samples.begin(), samples.end());
    say(bytes, stamp);
  }
};

// ---- IMUs -----------------------------------------------------------------------------------

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

[[noreturn]] void refuse(const std::string& name) {
  throw std::invalid_argument{"the simulated vehicle cannot speak '" + name +
                              "'; lidars: ld06, rplidar, ydlidar; IMUs: witmotion, xsens, "
                              "vectornav, bno08x-rvc; wheels: canopen, odrive, vesc, dbc"};
}

template <typename Port>
SerialPortPointer make_port(SerialPort& inner) {
  return SerialPortPointer{new Port(inner),
                           [](SerialPort* port) { delete static_cast<Port*>(port); }};
}

}  // namespace

SerialPortPointer make_lidar_dialect(const std::string& name, SerialPort& ld06) {
  if (name == "ld06") { return make_port<Passing>(ld06); }
  if (name == "rplidar") { return make_port<RplidarDialect>(ld06); }
  if (name == "ydlidar") { return make_port<YdlidarDialect>(ld06); }
  refuse(name);
}

SerialPortPointer make_imu_dialect(const std::string& name, SerialPort& witmotion) {
  if (name == "witmotion") { return make_port<Passing>(witmotion); }
  if (name == "xsens") { return make_port<XsensDialect>(witmotion); }
  if (name == "vectornav") { return make_port<VectornavDialect>(witmotion); }
  if (name == "bno08x-rvc") { return make_port<Bno08xDialect>(witmotion); }
  refuse(name);
}

}  // namespace picolo::inline v0::devices
