// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "decode/lidars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "decode/table.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/drivers/rplidar/rplidar.hpp"
#include "picolo/drivers/scip/scip.hpp"
#include "picolo/drivers/ydlidar/ydlidar.hpp"

namespace picolo::tool {
namespace {

double degrees(double value, int decimals_scale) {
  return std::round(value * decimals_scale) / decimals_scale;
}

RplidarMode mode_of(const std::string& name) {
  if (name == "express") { return RplidarMode::express; }
  if (name == "ultra") { return RplidarMode::ultra; }
  if (name == "dense") { return RplidarMode::dense; }
  return RplidarMode::standard;
}

/// How many neighbours are about as far away as each other: walls are, misread bits are not.
std::size_t smooth_neighbours(std::span<const std::uint8_t> bytes, RplidarMode mode) {
  std::array<RplidarNode, kRplidarMaxNodes> nodes{};
  RplidarCapsules capsules{mode};
  std::size_t smooth = 0;
  for (const std::uint8_t byte : bytes) {
    const std::size_t count = capsules.push(byte, nodes);
    for (std::size_t i = 1; i < count; ++i) {
      const auto [near, far] = std::minmax(nodes[i - 1].dist_mm_q2, nodes[i].dist_mm_q2);
      smooth += near > 0 && far - near < far / 16 ? 1U : 0U;
    }
  }
  return smooth;
}

/// A stream that shows no descriptor is of the mode that makes most of its bytes. Express and dense
/// capsules look alike but for what they say.
RplidarMode likeliest_mode(std::span<const std::uint8_t> bytes) {
  std::array<RplidarNode, kRplidarMaxNodes> nodes{};
  RplidarStandardDecoder standard;
  RplidarCapsules express{RplidarMode::express};
  RplidarCapsules ultra{RplidarMode::ultra};
  for (const std::uint8_t byte : bytes) {
    static_cast<void>(standard.push(byte));
    static_cast<void>(express.push(byte, nodes));
    static_cast<void>(ultra.push(byte, nodes));
  }
  const std::size_t in_standard = standard.counters().frames * std::size_t{5};
  const std::size_t in_express = express.counters().frames * express.capsule_size();
  const std::size_t in_ultra = ultra.counters().frames * ultra.capsule_size();
  if (in_ultra > in_standard && in_ultra > in_express) { return RplidarMode::ultra; }
  if (in_express <= in_standard) { return RplidarMode::standard; }
  const bool dense =
      smooth_neighbours(bytes, RplidarMode::dense) > smooth_neighbours(bytes, RplidarMode::express);
  return dense ? RplidarMode::dense : RplidarMode::express;
}

}  // namespace

DecodeResult decode_ld06(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"timestamp_ms", "speed_degps", "angle_deg", "distance_mm", "intensity"},
                    options.format};
  Ld06Decoder decoder;
  for (const std::uint8_t byte : bytes) {
    if (!is_ok(decoder.push(byte))) { continue; }
    const Ld06Packet& packet = decoder.packet();
    for (std::size_t i = 0; i < packet.points.size(); ++i) {
      const double angle = packet.start_cdeg +
                           static_cast<double>(span_cdeg(packet)) * static_cast<double>(i) / 11.0;
      table.row({packet.timestamp_ms, packet.speed_degps,
                 degrees(std::fmod(angle, 36'000.0) / 100.0, 10'000), packet.points[i].distance_mm,
                 packet.points[i].intensity});
    }
  }
  const FramerCounters& c = decoder.counters();
  return {.samples = table.rows(),
          .counters = {.frames = c.frames,
                       .bad_checksums = c.bad_checksums,
                       .implausible = c.implausible,
                       .skipped_bytes = c.skipped_bytes}};
}

DecodeResult decode_rplidar(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"angle_z_q14", "dist_mm_q2", "quality", "flag"}, options.format};
  const RplidarConfig config{
      .mode = options.mode.empty() ? likeliest_mode(bytes) : mode_of(options.mode),
      .active = false};
  RplidarProtocol protocol{config};
  std::array<RangeReading, RplidarProtocol::kMaxSamplesPerByte> readings{};
  auto print = [&] {
    for (const RplidarNode& node : protocol.nodes()) {
      table.row({node.angle_z_q14, node.dist_mm_q2, node.quality, node.flag});
    }
  };
  for (const std::uint8_t byte : bytes) {
    protocol.push(byte, {}, readings);
    print();
  }
  while (protocol.flush() > 0) { print(); }
  return {.samples = table.rows(), .counters = protocol.counters()};
}

DecodeResult decode_scip(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"time_ms", "step", "angle_deg", "distance_mm"}, options.format};
  ScipProtocol protocol{{.active = false}};
  std::array<RangeReading, 64> readings{};
  for (const std::uint8_t byte : bytes) {
    protocol.push(byte, {}, readings);
    if (!protocol.scan_ready()) { continue; }
    const ScipScan& scan = protocol.scan();
    for (std::size_t i = 0; i < scan.command().values(); ++i) {
      const auto step = static_cast<int>(scan.command().first_step + i * scan.command().cluster);
      const double angle = (step - static_cast<int>(protocol.model().front_step)) * 360.0 /
                           protocol.model().steps_per_turn;
      table.row({scan.time_ms(), step, degrees(angle, 10'000), scan.value(i)});
    }
    while (protocol.pull(readings) > 0) {}
  }
  return {.samples = table.rows(), .counters = protocol.counters()};
}

DecodeResult decode_ydlidar(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"angle_deg", "distance_mm", "intensity", "flag", "start_packet"},
                    options.format};
  YdlidarProtocol protocol{{.optics = YdlidarOptics::aligned, .active = false}};
  std::vector<RangeReading> readings(YdlidarProtocol::kMaxSamplesPerByte);
  for (const std::uint8_t byte : bytes) {
    if (protocol.push(byte, {}, readings) == 0) { continue; }
    const YdlidarHeader& header = protocol.header();
    const int intervals = std::max(1, header.count - 1);
    double span = static_cast<double>(header.last_q6) - header.first_q6;
    if (span < 0) { span += 360.0 * 64; }
    for (std::size_t i = 0; i < protocol.points().size(); ++i) {
      const YdlidarPoint& point = protocol.points()[i];
      const double angle =
          std::fmod((header.first_q6 + span * static_cast<double>(i) / intervals) / 64.0, 360.0);
      table.row({degrees(angle, 10'000), point.distance_mm, point.intensity, point.flags,
                 header.starts_scan ? 1 : 0});
    }
  }
  return {.samples = table.rows(), .counters = protocol.counters()};
}

}  // namespace picolo::tool
