// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "wires.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/drivers/bno08x/bno08x_rvc.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/drivers/rplidar/rplidar.hpp"
#include "picolo/drivers/scip/scip.hpp"
#include "picolo/drivers/vectornav/vectornav.hpp"
#include "picolo/drivers/witmotion/witmotion_frame.hpp"
#include "picolo/drivers/xsens/xsens.hpp"
#include "picolo/drivers/ydlidar/ydlidar.hpp"

namespace picolo::test {
namespace {

void be(Bytes& out, std::uint64_t value, std::size_t size) {
  for (std::size_t i = size; i > 0; --i) {
    out.push_back(static_cast<std::uint8_t>(value >> (8 * (i - 1))));
  }
}

// ---- LD06: the number is in the distances ------------------------------------------------------

Bytes ld06_packet(std::uint32_t number) {
  Bytes bytes(47);
  bytes[0] = 0x54;
  bytes[1] = 0x2C;
  store_u16_le(bytes, 2, 3600);
  store_u16_le(bytes, 4, static_cast<std::uint16_t>(number * 960 % 36'000));
  for (std::size_t i = 0; i < 12; ++i) {
    store_u16_le(bytes, 6 + 3 * i, static_cast<std::uint16_t>(1000 + 12 * number + i));
    bytes[8 + 3 * i] = 200;
  }
  store_u16_le(bytes, 42, static_cast<std::uint16_t>((number * 960 + 880) % 36'000));
  store_u16_le(bytes, 44, static_cast<std::uint16_t>(number * 3));
  bytes[46] = crc8(std::span<const std::uint8_t>{bytes}.first(46), 0x4D);
  return bytes;
}

std::vector<Accepted> ld06_read(const Bytes& stream) {
  std::vector<Accepted> all;
  Ld06Decoder decoder;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (!is_ok(decoder.push(stream[i]))) { continue; }
    const Ld06Packet& packet = decoder.packet();
    const std::uint32_t number = (packet.points[0].distance_mm - 1000U) / 12U;
    bool intact = packet.start_cdeg == number * 960 % 36'000;
    for (std::size_t k = 0; k < 12; ++k) {
      intact = intact && packet.points[k].distance_mm == 1000 + 12 * number + k &&
               packet.points[k].intensity == 200;
    }
    all.push_back({number, i + 1, intact});
  }
  return all;
}

// ---- RPLIDAR standard nodes --------------------------------------------------------------------

Bytes rplidar_packet(std::uint32_t number) {
  const std::uint32_t angle_q6 = number * 360 * 64 / 200;
  const std::uint32_t dist_q2 = 4000 + number * 8;
  return {static_cast<std::uint8_t>(number == 0 ? 0x3D : 0x3E),
          static_cast<std::uint8_t>(((angle_q6 & 0x7FU) << 1U) | 1U),
          static_cast<std::uint8_t>(angle_q6 >> 7U), static_cast<std::uint8_t>(dist_q2 & 0xFFU),
          static_cast<std::uint8_t>(dist_q2 >> 8U)};
}

std::vector<Accepted> rplidar_read(const Bytes& stream) {
  std::vector<Accepted> all;
  RplidarStandardDecoder decoder;
  auto keep = [&](std::size_t at) {
    const RplidarNode& node = decoder.node();
    const std::uint32_t number = (node.dist_mm_q2 - 4000U) / 8U;
    const std::uint32_t angle_q6 = number * 360 * 64 / 200;
    const bool intact = node.dist_mm_q2 >= 4000 && number < 200 &&
                        node.dist_mm_q2 == 4000 + number * 8 &&
                        node.angle_z_q14 == (angle_q6 << 8U) / 90U;
    all.push_back({number, at, intact});
  };
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (is_ok(decoder.push(stream[i]))) { keep(i + 1); }
  }
  while (is_ok(decoder.flush())) { keep(stream.size()); }
  return all;
}

// ---- YDLIDAR -----------------------------------------------------------------------------------

/// As irregular as a room is: a ramp would be a weak spot of an exclusive-or.
std::uint16_t ydlidar_mm(std::uint32_t number, std::size_t sample) {
  if (sample == 0) { return static_cast<std::uint16_t>(1000 + number); }
  const std::uint32_t mixed = (number * 40U + static_cast<std::uint32_t>(sample)) * 2'654'435'761U;
  return static_cast<std::uint16_t>(500 + (mixed >> 16U) % 7000U);
}

Bytes ydlidar_packet(std::uint32_t number) {
  constexpr std::size_t kSamples = 40;
  Bytes bytes(10 + 2 * kSamples);
  bytes[0] = 0xAA;
  bytes[1] = 0x55;
  bytes[3] = kSamples;
  const std::uint32_t first = number * 40 % 360 * 64;
  store_u16_le(bytes, 4, static_cast<std::uint16_t>((first << 1U) | 1U));
  store_u16_le(bytes, 6, static_cast<std::uint16_t>(((first + 39 * 64) % (360 * 64) << 1U) | 1U));
  unsigned sum =
      load_u16_le(bytes, 0) ^ load_u16_le(bytes, 2) ^ load_u16_le(bytes, 4) ^ load_u16_le(bytes, 6);
  for (std::size_t i = 0; i < kSamples; ++i) {
    store_u16_le(bytes, 10 + 2 * i, static_cast<std::uint16_t>(ydlidar_mm(number, i) << 2U));
    sum ^= load_u16_le(bytes, 10 + 2 * i);
  }
  store_u16_le(bytes, 8, static_cast<std::uint16_t>(sum));
  return bytes;
}

std::vector<Accepted> ydlidar_read(const Bytes& stream) {
  std::vector<Accepted> all;
  YdlidarProtocol protocol{{.sample_bytes = 2, .active = false}};
  std::vector<RangeReading> readings(YdlidarProtocol::kMaxSamplesPerByte);
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (protocol.push(stream[i], {}, readings) == 0) { continue; }
    const std::uint32_t number = protocol.points()[0].distance_mm - 1000U;
    bool intact =
        protocol.points().size() == 40 && protocol.header().first_q6 == number * 40 % 360 * 64;
    for (std::size_t k = 0; k < protocol.points().size(); ++k) {
      intact = intact && protocol.points()[k].distance_mm == ydlidar_mm(number, k);
    }
    all.push_back({number, i + 1, intact});
  }
  return all;
}

// ---- SCIP: a packet is a whole scan, a damaged one lacks values
// ----------------------------------

Bytes scip_packet(std::uint32_t number) {
  Bytes out;
  auto line = [&out](const std::string& text, bool with_sum) {
    const Bytes bytes{text.begin(), text.end()};
    out.insert(out.end(), bytes.begin(), bytes.end());
    if (with_sum) { out.push_back(scip_sum(bytes)); }
    out.push_back('\n');
  };
  auto coded = [](std::uint32_t value, int size) {
    std::string text;
    for (int i = size - 1; i >= 0; --i) {
      text.push_back(static_cast<char>(((value >> (6 * i)) & 0x3FU) + 0x30U));
    }
    return text;
  };
  line("MD0100018101000", false);
  line("99b", false);
  line(coded(25 * number, 4), true);
  std::string data;
  for (std::uint32_t i = 0; i < 82; ++i) { data += coded(1000 + 100 * number + i, 3); }
  for (std::size_t at = 0; at < data.size(); at += 64) { line(data.substr(at, 64), true); }
  out.push_back('\n');
  return out;
}

std::vector<Accepted> scip_read(const Bytes& stream) {
  std::vector<Accepted> all;
  ScipProtocol protocol{{.active = false}};
  std::array<RangeReading, 32> readings{};
  for (std::size_t i = 0; i < stream.size(); ++i) {
    protocol.push(stream[i], {}, readings);
    if (!protocol.scan_ready()) { continue; }
    // The number is told by most of the values; lost ones are 0, and none may be another.
    std::uint32_t number = 9999;
    bool intact = true;
    for (std::size_t k = 0; k < protocol.scan().command().values(); ++k) {
      const std::uint32_t value = protocol.scan().value(k);
      if (value == 0) { continue; }
      if (number == 9999) { number = (value - 1000U) / 100U; }
      intact = intact && value == 1000 + 100 * number + k;
    }
    all.push_back({number, i + 1, intact && number != 9999});
    while (protocol.pull(readings) > 0) {}
  }
  return all;
}

// ---- IMUs --------------------------------------------------------------------------------------

Bytes witmotion_packet(std::uint32_t number) {
  Bytes bytes{0x55, 0x52};
  bytes.resize(11);
  for (std::size_t i = 0; i < 4; ++i) {
    store_u16_le(bytes, 2 + 2 * i, static_cast<std::uint16_t>(100 + 4 * number + i));
  }
  bytes[10] = sum8(std::span<const std::uint8_t>{bytes}.first(10));
  return bytes;
}

std::vector<Accepted> witmotion_read(const Bytes& stream) {
  std::vector<Accepted> all;
  WitMotionDecoder decoder;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (!is_ok(decoder.push(stream[i]))) { continue; }
    const auto& words = decoder.frame().words;
    const auto number = static_cast<std::uint32_t>(words[0] - 100) / 4U;
    bool intact = decoder.frame().type == WitMotionType::rate;
    for (std::size_t k = 0; k < 4; ++k) {
      intact = intact && static_cast<std::uint32_t>(words[k]) == 100 + 4 * number + k;
    }
    all.push_back({number, i + 1, intact});
  }
  return all;
}

Bytes rvc_packet(std::uint32_t number) {
  Bytes bytes(19);
  bytes[0] = 0xAA;
  bytes[1] = 0xAA;
  bytes[2] = static_cast<std::uint8_t>(number);
  for (std::size_t i = 0; i < 6; ++i) {
    store_u16_le(bytes, 3 + 2 * i, static_cast<std::uint16_t>(10 * number + i));
  }
  bytes[18] = sum8(std::span<const std::uint8_t>{bytes}.subspan(2, 16));
  return bytes;
}

std::vector<Accepted> rvc_read(const Bytes& stream) {
  std::vector<Accepted> all;
  Bno08xRvcProtocol protocol;
  std::array<ImuSample, 1> samples{};
  for (std::size_t i = 0; i < stream.size(); ++i) {
    protocol.push(stream[i], {}, samples);
    if (!protocol.frame_ready()) { continue; }
    const Bno08xRvcFrame& frame = protocol.frame();
    const std::uint32_t number = frame.index;
    const bool intact = frame.yaw_cdeg == static_cast<int>(10 * number) &&
                        frame.pitch_cdeg == static_cast<int>(10 * number + 1) &&
                        frame.roll_cdeg == static_cast<int>(10 * number + 2) &&
                        frame.acceleration_mg[0] == static_cast<int>(10 * number + 3) &&
                        frame.acceleration_mg[1] == static_cast<int>(10 * number + 4) &&
                        frame.acceleration_mg[2] == static_cast<int>(10 * number + 5);
    all.push_back({number, i + 1, intact});
  }
  return all;
}

Bytes xsens_packet(std::uint32_t number) {
  Bytes data{0x10, 0x20, 2};
  be(data, number, 2);
  data.insert(data.end(), {0x80, 0x20, 12});
  for (std::uint32_t i = 0; i < 3; ++i) {
    be(data, std::bit_cast<std::uint32_t>(static_cast<float>(number + i)), 4);
  }
  Bytes bytes{0xFA, 0xFF, 0x36, static_cast<std::uint8_t>(data.size())};
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.push_back(
      static_cast<std::uint8_t>(0U - sum8(std::span<const std::uint8_t>{bytes}.subspan(1))));
  return bytes;
}

std::vector<Accepted> xsens_read(const Bytes& stream) {
  std::vector<Accepted> all;
  XsensProtocol protocol;
  std::array<ImuSample, XsensProtocol::kMaxSamplesPerByte> samples{};
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (protocol.push(stream[i], {}, samples) == 0) { continue; }
    const std::uint32_t number = protocol.data().packet_counter.value_or(9999);
    bool intact = true;
    for (std::size_t k = 0; k < 3; ++k) {
      intact = intact && (*protocol.data().rate_radps)[k] ==
                             static_cast<float>(number + static_cast<std::uint32_t>(k));
    }
    all.push_back({number, i + 1, intact});
  }
  return all;
}

Bytes vn_binary_packet(std::uint32_t number) {
  Bytes bytes{0xFA, 0x01, 0x21, 0x01};
  const std::uint64_t time_ns = std::uint64_t{number} * 1'000'000;
  for (std::size_t i = 0; i < 8; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(time_ns >> (8 * i)));
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number + i));
    for (unsigned k = 0; k < 4; ++k) {
      bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * k)));
    }
  }
  be(bytes, crc16_ccitt(std::span<const std::uint8_t>{bytes}.subspan(1)), 2);
  return bytes;
}

Bytes vn_text_packet(std::uint32_t number) {
  char text[160];
  std::snprintf(text, sizeof text, "VNYMR,0,0,0,0,0,0,%u,%u,%u,%u,%u,%u", number, number + 1,
                number + 2, number + 3, number + 4, number + 5);
  const Bytes body{text, text + std::strlen(text)};
  char line[180];
  std::snprintf(line, sizeof line, "$%s*%02X\r\n", text, xor8(body));
  return {line, line + std::strlen(line)};
}

std::vector<Accepted> vn_read(const Bytes& stream) {
  std::vector<Accepted> all;
  VectornavProtocol protocol;
  std::array<ImuSample, VectornavProtocol::kMaxSamplesPerByte> samples{};
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (protocol.push(stream[i], {}, samples) == 0) { continue; }
    const VectornavData& data = protocol.data();
    const bool binary = data.time_startup_ns.has_value();
    // Binary: rate, then acceleration; text the other way round.
    const auto& first = binary ? *data.rate_radps : *data.acceleration_mps2;
    const auto& second = binary ? *data.acceleration_mps2 : *data.rate_radps;
    const auto number = static_cast<std::uint32_t>(std::max(0.0F, std::min(first[0], 9999.0F)));
    bool intact = true;
    for (std::uint32_t k = 0; k < 3; ++k) {
      intact = intact && first.at(k) == static_cast<float>(number + k) &&
               second.at(k) == static_cast<float>(number + 3 + k);
    }
    all.push_back({number, i + 1, intact});
  }
  return all;
}

}  // namespace

std::vector<Wire> all_wires() {
  std::vector<Wire> wires{
      {"ld06", ld06_packet, ld06_read, 8 + 16},
      {"rplidar 0x81", rplidar_packet, rplidar_read, 2, 20},
      {"scip", scip_packet, scip_read, 6},
      {"ydlidar", ydlidar_packet, ydlidar_read, 16 + 16, 0, 360},
      {"witmotion", witmotion_packet, witmotion_read, 8 + 12},
      {"bno08x-rvc", rvc_packet, rvc_read, 8 + 16},
      {"xsens", xsens_packet, xsens_read, 8 + 16},
      {"vectornav bin", vn_binary_packet, vn_read, 16 + 8},
      {"vectornav text", vn_text_packet, vn_read, 8 + 24, 1},
  };
  const std::vector<Wire> capsules = capsule_wires();
  wires.insert(wires.begin() + 2, capsules.begin(), capsules.end());
  return wires;
}

}  // namespace picolo::test
