// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/xsens/xsens_message.hpp"

#include "picolo/core/crc.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/wire_float.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kPreamble = 0xFA;
constexpr std::uint8_t kMaster = 0xFF;
constexpr std::uint8_t kExtended = 0xFF;

struct Extent {
  std::size_t data_at = 4;
  std::size_t data_size = 0;
};

/// Precondition: the length bytes are there.
Extent extent_of(ByteView bytes) {
  if (bytes[3] != kExtended) { return {4, bytes[3]}; }
  return {6, load_u16_be(bytes, 4)};
}

std::uint64_t load_u64_be(ByteView bytes, std::size_t at) {
  return (std::uint64_t{load_u32_be(bytes, at)} << 32U) | load_u32_be(bytes, at + 4);
}

constexpr std::array<std::size_t, 4> kNumberSizes{4, 4, 6, 8};

/// One number in the format that the low two bits of the item's identifier name.
Result<float> read_number(ByteView bytes, unsigned format) {
  switch (format) {
    case 0: return float_from_bits(load_u32_be(bytes, 0));
    case 1: return float_from_fixed(load_i32_be(bytes, 0), 20);
    case 2: {
      // fp16.32: the fraction comes first
      const auto whole = static_cast<std::int16_t>(load_u16_be(bytes, 4));
      return float_from_fixed(std::int64_t{whole} * (std::int64_t{1} << 32) +
                                  static_cast<std::int64_t>(load_u32_be(bytes, 0)),
                              32);
    }
    default: return float_from_f64_bits(load_u64_be(bytes, 0));
  }
}

template <std::size_t N>
bool read_vector(ByteView item, unsigned format, std::optional<std::array<float, N>>& out) {
  const std::size_t size = kNumberSizes[format];
  if (item.size() < N * size) { return false; }
  std::array<float, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const Result<float> value = read_number(item.subspan(i * size, size), format);
    if (!value) { return false; }
    values[i] = *value;
  }
  out = values;
  return true;
}

/// False: too short for what it says it is.
bool read_item(std::uint16_t identifier, ByteView item, XsensData& data) {
  const unsigned format = identifier & 3U;
  switch (identifier & 0xFFF0U) {
    case 0x1020:
      if (item.size() < 2) { return false; }
      data.packet_counter = load_u16_be(item, 0);
      return true;
    case 0x1060:
      if (item.size() < 4) { return false; }
      data.sample_time_100us = load_u32_be(item, 0);
      return true;
    case 0x2010: return read_vector(item, format, data.quaternion);
    case 0x2030: return read_vector(item, format, data.euler_deg);
    case 0x4020: return read_vector(item, format, data.acceleration_mps2);
    case 0x4040: return data.acceleration_mps2 || read_vector(item, format, data.acceleration_mps2);
    case 0x8020: return read_vector(item, format, data.rate_radps);
    case 0x8040: return data.rate_radps || read_vector(item, format, data.rate_radps);
    case 0xC020: return read_vector(item, format, data.magnetic);
    case 0xE020:
      if (item.size() < 4) { return false; }
      data.status = load_u32_be(item, 0);
      return true;
    default: ++data.unknown_items; return true;
  }
}

}  // namespace

FrameCheck XsensFormat::check(ByteView bytes) const {
  if (bytes[0] != kPreamble || (bytes.size() > 1 && bytes[1] != kMaster)) {
    return {FrameVerdict::no_header};
  }
  if (bytes.size() < 5) { return {FrameVerdict::incomplete}; }
  if (bytes[3] == kExtended && bytes.size() < 6) { return {FrameVerdict::incomplete}; }
  const Extent extent = extent_of(bytes);
  if (extent.data_size > kXsensMaxData) { return {FrameVerdict::no_header}; }
  const std::size_t size = extent.data_at + extent.data_size + 1;
  if (bytes.size() < size) { return {FrameVerdict::incomplete}; }
  if (sum8(bytes.subspan(1, size - 1)) != 0) { return {FrameVerdict::checksum}; }
  return {FrameVerdict::complete, size};
}

std::uint8_t xsens_message_id(ByteView frame) {
  return frame[2];
}

XsensData parse_xsens(ByteView frame) {
  XsensData data;
  const Extent extent = extent_of(frame);
  ByteView rest = frame.subspan(extent.data_at, extent.data_size);
  while (rest.size() >= 3) {
    const std::size_t size = rest[2];
    if (rest.size() < 3 + size) { break; }
    if (!read_item(load_u16_be(rest, 0), rest.subspan(3, size), data)) { data.damaged = true; }
    rest = rest.subspan(3 + size);
  }
  if (!rest.empty()) { data.damaged = true; }
  return data;
}

}  // namespace picolo::inline v0
