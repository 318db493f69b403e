// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ydlidar/ydlidar.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/polar.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kFullTurnQ6 = 360 * 64;
constexpr std::uint32_t kBadInARow = 20;

/// Clockwise, added to the nominal angle.
float optical_correction_rad(YdlidarOptics optics, std::uint16_t distance_mm) {
  if (distance_mm == 0) { return 0.0F; }
  const auto d = static_cast<float>(distance_mm);
  switch (optics) {
    case YdlidarOptics::aligned: return 0.0F;
    case YdlidarOptics::triangular: return arc_tangent2(21.8F * (155.3F - d), 155.3F * d);
    case YdlidarOptics::short_base: return arc_tangent2(17.8F, d);
  }
  return 0.0F;
}

float wrapped(float bearing_rad) {
  constexpr float kPi = 3.14159265F;
  if (bearing_rad > kPi) { return bearing_rad - 2.0F * kPi; }
  if (bearing_rad < -kPi) { return bearing_rad + 2.0F * kPi; }
  return bearing_rad;
}

}  // namespace

YdlidarProtocol::YdlidarProtocol(const YdlidarConfig& config)
    : config_(config),
      framer_(YdlidarFormat{config.sample_bytes}),
      timeline_(config.samples_per_second) {}

void YdlidarProtocol::read_points(ByteView packet) {
  header_ = parse_ydlidar(packet);
  const std::size_t width = (packet.size() - kYdlidarHeaderSize) / header_.count;
  framer_.set_format({width});
  const std::int32_t intervals = header_.count > 1 ? header_.count - 1 : 1;
  std::int32_t span_q6 = header_.last_q6 - header_.first_q6;
  if (span_q6 < 0) { span_q6 += kFullTurnQ6; }
  for (std::size_t i = 0; i < header_.count; ++i) {
    std::size_t at = kYdlidarHeaderSize + i * width;
    YdlidarPoint& point = points_[i];
    point = {};
    if (width == 3) {
      point.intensity = packet[at];
      ++at;
    }
    const unsigned raw = load_u16_le(packet, at);
    point.distance_mm = static_cast<std::uint16_t>(raw >> 2U);
    if (width == 3) { point.flags = static_cast<std::uint8_t>(raw & 3U); }
    const std::int32_t along = span_q6 * static_cast<std::int32_t>(i) / intervals;
    point.angle_q6 = static_cast<std::uint16_t>((header_.first_q6 + along) % kFullTurnQ6);
  }
}

void YdlidarProtocol::convert(std::span<RangeReading> readings) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const YdlidarPoint& point = points_[i];
    readings[i].range_m = static_cast<float>(point.distance_mm) / 1000.0F;
    readings[i].bearing_rad = wrapped(clockwise_bearing_rad(point.angle_q6, kFullTurnQ6) -
                                      optical_correction_rad(config_.optics, point.distance_mm));
    readings[i].starts_sweep = cutter_.passes_zero(point.angle_q6);
  }
}

/// A width is kept once a packet has shown it; only a long row of bad sums makes it doubtful.
void YdlidarProtocol::settle_width() {
  const std::uint32_t bad = framer_.counters().bad_checksums - bad_before_;
  if (config_.sample_bytes == 0 && bad > kBadInARow) { framer_.set_format({}); }
}

std::size_t YdlidarProtocol::push(std::uint8_t byte, const ByteTime& time,
                                  std::span<RangeReading> readings) {
  framer_.push(byte);
  std::size_t written = 0;
  while (framer_.next()) {
    bad_before_ = framer_.counters().bad_checksums;
    read_points(framer_.frame());
    deadline_ = time.arrived + config_.silence_timeout;
    const std::size_t count = header_.count;
    if (readings.size() - written < count) { break; }  // cannot be: the window holds no more
    const auto out = readings.subspan(written, count);
    convert(out);
    const std::size_t back = framer_.frame().size() + framer_.bytes_after_frame();
    timeline_.stamp(time.first_bit(back) - config_.latency, out);
    written += count;
  }
  samples_ += static_cast<std::uint32_t>(written);
  settle_width();
  return written;
}

std::size_t YdlidarProtocol::request(Timestamp now, std::span<std::uint8_t> out) {
  if (!config_.active || resting_ || now < deadline_) { return 0; }
  if (asked_) { ++restarts_; }
  asked_ = true;
  deadline_ = now + config_.silence_timeout;
  out[0] = 0xA5;
  out[1] = 0x60;
  return 2;
}

std::size_t YdlidarProtocol::farewell(std::span<std::uint8_t> out) {
  resting_ = true;
  out[0] = 0xA5;
  out[1] = 0x65;
  return 2;
}

void YdlidarProtocol::interrupted() {
  framer_.reset();
  deadline_ = Timestamp::min();
}

SerialCounters YdlidarProtocol::counters() const {
  const FramerCounters& framer = framer_.counters();
  return {.frames = framer.frames,
          .bad_checksums = framer.bad_checksums,
          .implausible = framer.implausible,
          .skipped_bytes = framer.skipped_bytes,
          .samples = samples_,
          .restarts = restarts_};
}

}  // namespace picolo::inline v0
