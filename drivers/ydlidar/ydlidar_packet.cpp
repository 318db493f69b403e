// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ydlidar/ydlidar_packet.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint16_t kFullTurnQ6 = 360 * 64;

bool is_angle(std::uint16_t word) {
  return (word & 1U) != 0 && (word >> 1U) <= kFullTurnQ6;
}

std::uint16_t checksum_of(ByteView bytes, std::size_t count, std::size_t sample_bytes) {
  std::uint16_t sum = load_u16_le(bytes, 0);
  sum = static_cast<std::uint16_t>(sum ^ load_u16_le(bytes, 2));
  sum = static_cast<std::uint16_t>(sum ^ load_u16_le(bytes, 4));
  sum = static_cast<std::uint16_t>(sum ^ load_u16_le(bytes, 6));
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t at = kYdlidarHeaderSize + i * sample_bytes;
    if (sample_bytes == 3) {
      sum = static_cast<std::uint16_t>(sum ^ bytes[at]);
      ++at;
    }
    sum = static_cast<std::uint16_t>(sum ^ load_u16_le(bytes, at));
  }
  return sum;
}

}  // namespace

YdlidarHeader parse_ydlidar(ByteView bytes) {
  return {.starts_scan = (bytes[2] & 1U) != 0,
          .frequency_dhz = static_cast<std::uint8_t>(bytes[2] >> 1U),
          .count = bytes[3],
          .first_q6 = static_cast<std::uint16_t>(load_u16_le(bytes, 4) >> 1U),
          .last_q6 = static_cast<std::uint16_t>(load_u16_le(bytes, 6) >> 1U)};
}

FrameCheck YdlidarFormat::check(ByteView bytes) const {
  if (bytes[0] != 0xAA || (bytes.size() > 1 && bytes[1] != 0x55)) {
    return {FrameVerdict::no_header};
  }
  if (bytes.size() > 3 && (bytes[3] == 0 || bytes[3] > kYdlidarMaxSamples)) {
    return {FrameVerdict::no_header};
  }
  if (bytes.size() < kYdlidarHeaderSize) { return {FrameVerdict::incomplete}; }
  if (!is_angle(load_u16_le(bytes, 4)) || !is_angle(load_u16_le(bytes, 6))) {
    return {FrameVerdict::no_header};
  }
  for (const std::size_t width : {std::size_t{2}, std::size_t{3}}) {
    if (sample_bytes != 0 && width != sample_bytes) { continue; }
    const std::size_t size = kYdlidarHeaderSize + bytes[3] * width;
    if (bytes.size() < size) { return {FrameVerdict::incomplete}; }
    if (checksum_of(bytes, bytes[3], width) == load_u16_le(bytes, 8)) {
      return {FrameVerdict::complete, size};
    }
  }
  return {FrameVerdict::checksum};
}

}  // namespace picolo::inline v0
