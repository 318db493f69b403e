// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// The simulated LD06 in the bytes of other lidars that turn clockwise.
#include <algorithm>
#include <stdexcept>

#include "dialect.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/drivers/common/turn_cutter.hpp"
#include "ultra_capsules.hpp"

namespace picolo::inline v0::devices {
namespace {

std::uint32_t angle_q6(const Ld06Packet& packet, std::size_t point) {
  const std::uint32_t along = span_cdeg(packet) * static_cast<std::uint32_t>(point) / 11U;
  return (packet.start_cdeg + along) % kLd06FullTurnCdeg * 64U / 100U;
}

/// Commands of two bytes, A5 and a letter; a payload behind them says nothing here.
class CommandedLidar : public LidarDialect {
 public:
  using LidarDialect::LidarDialect;

 protected:
  virtual void command(std::uint8_t letter) = 0;

 private:
  void obey(std::uint8_t byte) final {
    const bool is_command = before_ == 0xA5;
    before_ = is_command ? std::uint8_t{0} : byte;
    if (is_command) { command(byte); }
  }
  std::uint8_t before_ = 0;
};

class RplidarDialect final : public CommandedLidar {
 public:
  RplidarDialect(SerialPort& ld06, const std::string& mode)
      : CommandedLidar(ld06),
        capsules_(mode == "express" || mode == "ultra" || mode == "dense"),
        ultra_(mode == "ultra"),
        dense_(mode == "dense") {}

 private:
  void packet(const Ld06Packet& packet, Timestamp stamp) override {
    const Bytes bytes = capsules_ ? capsules(packet) : nodes(packet);
    if (scanning_ && !bytes.empty()) { say(bytes, stamp); }
    for (const Bytes& answer : answers_) { say(answer, stamp); }
    answers_.clear();
    scanning_ = scanning_ || starts_;
    starts_ = false;
  }

  Bytes nodes(const Ld06Packet& packet) {
    Bytes bytes;
    for (std::size_t i = 0; i < packet.points.size(); ++i) {
      const std::uint32_t angle = angle_q6(packet, i);
      const bool start = cutter_.passes_zero(angle);
      bytes.push_back(static_cast<std::uint8_t>((15U << 2U) | (start ? 1U : 2U)));
      add_u16(bytes, (angle << 1U) | 1U);
      add_u16(bytes, std::min<unsigned>(packet.points[i].distance_mm * 4U, 0xFFFFU));
    }
    return bytes;
  }

  /// A capsule has 32, 96 or 40 points, a packet 12: now and then one is full.
  Bytes capsules(const Ld06Packet& packet) {
    Bytes full;
    for (std::size_t i = 0; i < packet.points.size(); ++i) {
      if (ultra_) {
        Bytes capsule = ultra_capsules_.push(angle_q6(packet, i), packet.points[i].distance_mm);
        if (!capsule.empty()) { full = std::move(capsule); }
        continue;
      }
      if (points_mm_.empty()) { start_q6_ = angle_q6(packet, i); }
      points_mm_.push_back(packet.points[i].distance_mm);
      if (points_mm_.size() < (dense_ ? 40 : 32)) { continue; }
      full = capsule();
      points_mm_.clear();
    }
    return full;
  }

  [[nodiscard]] Bytes capsule() const {
    Bytes bytes{0, 0};
    add_u16(bytes, start_q6_);
    for (std::size_t i = 0; i < points_mm_.size(); ++i) {
      add_u16(bytes, dense_ ? points_mm_[i] : std::min(points_mm_[i], 16'383U) << 2U);
      if (!dense_ && i % 2 == 1) { bytes.push_back(0); }  // no beam looks beside its angle
    }
    seal_capsule(bytes);
    return bytes;
  }

  void command(std::uint8_t letter) override {
    if (letter == 0x25) { scanning_ = false; }
    if (letter == 0x50) {
      Bytes answer{0xA5, 0x5A, 0x14, 0, 0, 0, 0x04, 0x18, 0, 1, 7};
      answer.resize(27);
      answers_.push_back(answer);
    }
    if (letter == 0x52) { answers_.push_back({0xA5, 0x5A, 0x03, 0, 0, 0, 0x06, 0, 0, 0}); }
    if (letter == 0x20 && !capsules_) {
      answers_.push_back({0xA5, 0x5A, 0x05, 0, 0, 0x40, 0x81});
      starts_ = true;
    }
    if (letter == 0x82 && capsules_) {
      Bytes descriptor = {0xA5, 0x5A, 0x54, 0, 0, 0x40, 0x82};
      if (ultra_) { descriptor = {0xA5, 0x5A, 0x84, 0, 0, 0x40, 0x84}; }
      if (dense_) { descriptor.back() = 0x85; }
      answers_.push_back(descriptor);
      starts_ = true;
      points_mm_.clear();
    }
  }

  const bool capsules_;
  const bool ultra_;
  const bool dense_;
  UltraCapsules ultra_capsules_;
  TurnCutter cutter_{360 * 64};
  std::uint32_t start_q6_ = 0;
  std::vector<unsigned> points_mm_;
  std::vector<Bytes> answers_;
  bool scanning_ = false;
  bool starts_ = false;
};

class YdlidarDialect final : public CommandedLidar {
 public:
  using CommandedLidar::CommandedLidar;

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
    if (scanning_) { say(bytes, stamp); }
    if (starts_) { say({0xA5, 0x5A, 0x05, 0, 0, 0x40, 0x81}, stamp); }
    scanning_ = scanning_ || starts_;
    starts_ = false;
  }

  void command(std::uint8_t letter) override {
    starts_ = letter == 0x60 && !scanning_;
    if (letter == 0x65) { scanning_ = false; }
  }

  bool scanning_ = false;
  bool starts_ = false;
};

}  // namespace

void refuse_dialect(const std::string& name) {
  throw std::invalid_argument{"the simulated vehicle cannot speak '" + name +
                              "'; lidars: ld06, rplidar, ydlidar, scip; IMUs: "
                              "witmotion, xsens, vectornav, bno08x-rvc; wheels: canopen, odrive, "
                              "vesc, dbc"};
}

SerialPortPointer make_lidar_dialect(const std::string& name, SerialPort& ld06,
                                     const std::string& mode) {
  if (name == "ld06") { return make_port<PassingLine>(ld06); }
  if (name == "rplidar") { return make_port<RplidarDialect>(ld06, mode); }
  if (name == "ydlidar") { return make_port<YdlidarDialect>(ld06); }
  if (name == "scip") { return make_scip_dialect(ld06); }
  refuse_dialect(mode.empty() ? name : name + " " + mode);
}

bool turns_counter_clockwise(const std::string& name) {
  return name == "scip";
}

}  // namespace picolo::inline v0::devices
