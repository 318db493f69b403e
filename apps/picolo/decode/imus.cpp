// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "decode/imus.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "decode/table.hpp"
#include "picolo/drivers/bno08x/bno08x_rvc.hpp"
#include "picolo/drivers/vectornav/vectornav.hpp"
#include "picolo/drivers/witmotion/witmotion_frame.hpp"
#include "picolo/drivers/xsens/xsens.hpp"

namespace picolo::tool {
namespace {

using Row = std::vector<host::Json>;

/// The shortest decimal that reads back as the same float.
host::Json number(float value) {
  return host::Json::parse(fmt::format("{}", value + 0.0F), nullptr, false);
}

void add(Row& row, float value) {
  row.push_back(number(value));
}

template <std::size_t N>
void add(Row& row, const std::optional<std::array<float, N>>& values) {
  for (std::size_t i = 0; i < N; ++i) {
    if (values) {
      add(row, (*values)[i]);
    } else {
      row.emplace_back(nullptr);
    }
  }
}

template <typename T>
void add(Row& row, const std::optional<T>& value) {
  if (value) {
    row.emplace_back(*value);
  } else {
    row.emplace_back(nullptr);
  }
}

struct Scaled {
  const char* quantity;
  double scale;  ///< of a word
  const char* unit;
};

Scaled scaled(WitMotionType type) {
  switch (type) {
    case WitMotionType::acceleration: return {"acceleration", 16.0 / 32768.0, "g"};
    case WitMotionType::rate: return {"rate", 2000.0 / 32768.0, "deg/s"};
    case WitMotionType::angle: return {"angle", 180.0 / 32768.0, "deg"};
    case WitMotionType::magnetic: return {"magnetic", 1.0, ""};
    case WitMotionType::quaternion: return {"quaternion", 1.0 / 32768.0, ""};
    case WitMotionType::time: return {"time", 1.0, ""};
    case WitMotionType::ports: return {"ports", 1.0, ""};
    case WitMotionType::pressure: return {"pressure", 1.0, ""};
    case WitMotionType::position: return {"position", 1.0, ""};
    case WitMotionType::gps: return {"gps", 1.0, ""};
    case WitMotionType::satellites: return {"satellites", 1.0, ""};
  }
  return {"other", 1.0, ""};
}

}  // namespace

DecodeResult decode_witmotion(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"type", "quantity", "raw0", "raw1", "raw2", "raw3", "x", "y", "z", "unit"},
                    options.format};
  WitMotionDecoder decoder;
  for (const std::uint8_t byte : bytes) {
    if (!is_ok(decoder.push(byte))) { continue; }
    const WitMotionFrame& frame = decoder.frame();
    const Scaled scale = scaled(frame.type);
    Row row{fmt::format("0x{:02X}", static_cast<unsigned>(frame.type)), scale.quantity};
    for (const std::int16_t word : frame.words) { row.emplace_back(word); }
    for (std::size_t i = 0; i < 3; ++i) { row.emplace_back(frame.words[i] * scale.scale); }
    row.emplace_back(scale.unit);
    table.row(row);
  }
  const FramerCounters& c = decoder.counters();
  return {
      .samples = table.rows(),
      .counters = {
          .frames = c.frames, .bad_checksums = c.bad_checksums, .skipped_bytes = c.skipped_bytes}};
}

DecodeResult decode_bno08x(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"index", "yaw_deg", "pitch_deg", "roll_deg", "acceleration_x_mg",
                     "acceleration_y_mg", "acceleration_z_mg"},
                    options.format};
  Bno08xRvcProtocol protocol;
  std::array<ImuSample, Bno08xRvcProtocol::kMaxSamplesPerByte> samples{};
  for (const std::uint8_t byte : bytes) {
    protocol.push(byte, {}, samples);
    if (!protocol.frame_ready()) { continue; }
    const Bno08xRvcFrame& frame = protocol.frame();
    table.row({frame.index, frame.yaw_cdeg / 100.0, frame.pitch_cdeg / 100.0,
               frame.roll_cdeg / 100.0, frame.acceleration_mg[0], frame.acceleration_mg[1],
               frame.acceleration_mg[2]});
  }
  return {.samples = table.rows(), .counters = protocol.counters()};
}

DecodeResult decode_xsens(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{
      {"packet_counter", "sample_time_100us", "acceleration_x_mps2", "acceleration_y_mps2",
       "acceleration_z_mps2", "rate_x_radps", "rate_y_radps", "rate_z_radps", "quaternion_w",
       "quaternion_x", "quaternion_y", "quaternion_z", "roll_deg", "pitch_deg", "yaw_deg",
       "magnetic_x", "magnetic_y", "magnetic_z", "status"},
      options.format};
  XsensProtocol protocol{{.active = false}};
  std::array<ImuSample, XsensProtocol::kMaxSamplesPerByte> samples{};
  for (const std::uint8_t byte : bytes) {
    protocol.push(byte, {}, samples);
    if (!protocol.data_ready() || protocol.data().damaged) { continue; }
    const XsensData& data = protocol.data();
    Row row;
    add(row, data.packet_counter);
    add(row, data.sample_time_100us);
    add(row, data.acceleration_mps2);
    add(row, data.rate_radps);
    add(row, data.quaternion);
    add(row, data.euler_deg);
    add(row, data.magnetic);
    add(row, data.status);
    table.row(row);
  }
  return {.samples = table.rows(), .counters = protocol.counters()};
}

DecodeResult decode_vectornav(std::span<const std::uint8_t> bytes, const DecodeOptions& options) {
  SampleTable table{{"time_startup_ns", "yaw_deg", "pitch_deg", "roll_deg", "magnetic_x_gauss",
                     "magnetic_y_gauss", "magnetic_z_gauss", "acceleration_x_mps2",
                     "acceleration_y_mps2", "acceleration_z_mps2", "rate_x_radps", "rate_y_radps",
                     "rate_z_radps", "temperature_degc", "pressure_kpa"},
                    options.format};
  VectornavProtocol protocol;
  std::array<ImuSample, VectornavProtocol::kMaxSamplesPerByte> samples{};
  for (const std::uint8_t byte : bytes) {
    protocol.push(byte, {}, samples);
    if (!protocol.data_ready()) { continue; }
    const VectornavData& data = protocol.data();
    Row row;
    add(row, data.time_startup_ns);
    add(row, data.ypr_deg);
    add(row, data.magnetic_gauss);
    add(row, data.acceleration_mps2);
    add(row, data.rate_radps);
    for (const std::optional<float>& value : {data.temperature_degc, data.pressure_kpa}) {
      if (value) {
        add(row, *value);
      } else {
        row.emplace_back(nullptr);
      }
    }
    table.row(row);
  }
  return {.samples = table.rows(), .counters = protocol.counters()};
}

}  // namespace picolo::tool
