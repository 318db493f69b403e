// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/vectornav/vectornav_message.hpp"

#include <algorithm>

#include "picolo/core/crc.hpp"
#include "picolo/drivers/common/wire_float.hpp"
#include "vectornav_fields.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kSync = 0xFA;
constexpr std::size_t kMaxText = 200;
constexpr std::size_t kTextName = 6;  // "$VNYMR"
constexpr std::size_t kMaxNumbers = 12;

int digit_of(std::uint8_t c) {
  if (c >= '0' && c <= '9') { return c - '0'; }
  if (c >= 'A' && c <= 'F') { return c - 'A' + 10; }
  if (c >= 'a' && c <= 'f') { return c - 'a' + 10; }
  return -1;
}

/// The number that all of `digits` write, or -1.
std::int32_t hexadecimal(ByteView digits) {
  std::int32_t value = 0;
  for (const std::uint8_t c : digits) {
    const int digit = digit_of(c);
    if (digit < 0) { return -1; }
    value = value * 16 + digit;
  }
  return value;
}

FrameCheck check_text(ByteView bytes) {
  constexpr std::array<std::uint8_t, 3> kStart{'$', 'V', 'N'};
  const std::size_t known = std::min(bytes.size(), kStart.size());
  if (!std::equal(kStart.begin(), kStart.begin() + static_cast<std::ptrdiff_t>(known),
                  bytes.begin())) {
    return {FrameVerdict::no_header};
  }
  const auto star = std::find(bytes.begin(), bytes.end(), '*');
  const auto length = static_cast<std::size_t>(star - bytes.begin());
  const ByteView text = bytes.first(length);
  const bool printable =
      std::all_of(text.begin(), text.end(), [](std::uint8_t c) { return c >= 0x20 && c < 0x7F; });
  if (!printable || length > kMaxText) { return {FrameVerdict::no_header}; }
  // Two digits and something else, or four.
  if (bytes.size() < length + 4) { return {FrameVerdict::incomplete}; }
  const ByteView body = bytes.subspan(1, length - 1);
  if (digit_of(bytes[length + 3]) < 0) {
    const bool right = hexadecimal(bytes.subspan(length + 1, 2)) == xor8(body);
    return right ? FrameCheck{FrameVerdict::complete, length + 3}
                 : FrameCheck{FrameVerdict::checksum};
  }
  if (bytes.size() < length + 5) { return {FrameVerdict::incomplete}; }
  const bool right = hexadecimal(bytes.subspan(length + 1, 4)) == crc16_ccitt(body);
  return right ? FrameCheck{FrameVerdict::complete, length + 5}
               : FrameCheck{FrameVerdict::checksum};
}

FrameCheck check_binary(ByteView bytes) {
  const vectornav::Layout layout =
      vectornav::walk(bytes, [](std::size_t, std::size_t, std::size_t) {});
  if (!layout.known) { return {FrameVerdict::no_header}; }
  if (!layout.complete) { return {FrameVerdict::incomplete}; }
  const std::size_t size = layout.header_size + layout.payload_size + 2;
  if (size > VectornavFormat::kMaxFrame) { return {FrameVerdict::no_header}; }
  if (bytes.size() < size) { return {FrameVerdict::incomplete}; }
  if (crc16_ccitt(bytes.subspan(1, size - 1)) != 0) { return {FrameVerdict::checksum}; }
  return {FrameVerdict::complete, size};
}

template <std::size_t N>
void read_floats(ByteView bytes, std::size_t at, std::optional<std::array<float, N>>& out,
                 bool& damaged) {
  std::array<float, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const Result<float> value = float_from_bits(load_u32_le(bytes, at + 4 * i));
    damaged = damaged || !value;
    values[i] = value.value_or(0.0F);
  }
  out = values;
}

std::uint64_t load_u64_le(ByteView bytes, std::size_t at) {
  return load_u32_le(bytes, at) | (std::uint64_t{load_u32_le(bytes, at + 4)} << 32U);
}

void read_common(std::size_t bit, ByteView bytes, std::size_t at, VectornavData& data) {
  switch (bit) {
    case 0: data.time_startup_ns = load_u64_le(bytes, at); break;
    case 3: read_floats(bytes, at, data.ypr_deg, data.damaged); break;
    case 4: read_floats(bytes, at, data.quaternion, data.damaged); break;
    case 5: read_floats(bytes, at, data.rate_radps, data.damaged); break;
    case 8: read_floats(bytes, at, data.acceleration_mps2, data.damaged); break;
    case 9:
      // Uncompensated, where nothing better is in the message.
      if (!data.acceleration_mps2) { read_floats(bytes, at, data.acceleration_mps2, data.damaged); }
      if (!data.rate_radps) { read_floats(bytes, at + 12, data.rate_radps, data.damaged); }
      break;
    case 10: read_floats(bytes, at, data.magnetic_gauss, data.damaged); break;
    default: break;
  }
}

void read_imu(std::size_t bit, ByteView bytes, std::size_t at, VectornavData& data) {
  switch (bit) {
    case 2:
      if (!data.acceleration_mps2) { read_floats(bytes, at, data.acceleration_mps2, data.damaged); }
      break;
    case 3:
      if (!data.rate_radps) { read_floats(bytes, at, data.rate_radps, data.damaged); }
      break;
    case 8: read_floats(bytes, at, data.magnetic_gauss, data.damaged); break;
    case 9: read_floats(bytes, at, data.acceleration_mps2, data.damaged); break;
    case 10: read_floats(bytes, at, data.rate_radps, data.damaged); break;
    default: break;
  }
}

VectornavData parse_binary(ByteView frame) {
  VectornavData data;
  vectornav::walk(frame, [&](std::size_t group, std::size_t bit, std::size_t at) {
    if (group == 0) { read_common(bit, frame, at, data); }
    if (group == 1 && bit == 0) { data.time_startup_ns = load_u64_le(frame, at); }
    if (group == 2) { read_imu(bit, frame, at, data); }
  });
  return data;
}

struct Numbers {
  std::array<float, kMaxNumbers> values{};
  std::size_t count = 0;
  bool damaged = false;
};

Numbers read_numbers(ByteView text) {
  Numbers numbers;
  while (!text.empty() && numbers.count < kMaxNumbers) {
    const auto comma = std::find(text.begin(), text.end(), ',');
    const auto size = static_cast<std::size_t>(comma - text.begin());
    const Result<float> value = float_from_text(text.first(size));
    numbers.damaged = numbers.damaged || !value;
    numbers.values[numbers.count] = value.value_or(0.0F);
    ++numbers.count;
    text = text.subspan(std::min(size + 1, text.size()));
  }
  return numbers;
}

std::array<float, 3> three(const Numbers& numbers, std::size_t first) {
  return {numbers.values[first], numbers.values[first + 1], numbers.values[first + 2]};
}

bool is_named(ByteView frame, const char (&name)[4]) {
  return frame[3] == name[0] && frame[4] == name[1] && frame[5] == name[2];
}

Result<VectornavData> parse_text(ByteView frame) {
  const auto star = std::find(frame.begin(), frame.end(), '*');
  const auto length = static_cast<std::size_t>(star - frame.begin());
  if (length <= kTextName) { return Status::unsupported; }
  const Numbers numbers = read_numbers(frame.subspan(kTextName + 1, length - kTextName - 1));
  VectornavData data;
  if (is_named(frame, "YMR")) {
    if (numbers.count < 12) { return Status::corrupt; }
    data.ypr_deg = three(numbers, 0);
    data.magnetic_gauss = three(numbers, 3);
    data.acceleration_mps2 = three(numbers, 6);
    data.rate_radps = three(numbers, 9);
  } else if (is_named(frame, "IMU")) {
    if (numbers.count < 11) { return Status::corrupt; }
    data.magnetic_gauss = three(numbers, 0);
    data.acceleration_mps2 = three(numbers, 3);
    data.rate_radps = three(numbers, 6);
    data.temperature_degc = numbers.values[9];
    data.pressure_kpa = numbers.values[10];
  } else {
    return Status::unsupported;
  }
  data.damaged = numbers.damaged;
  return data;
}

}  // namespace

FrameCheck VectornavFormat::check(ByteView bytes) const {
  if (bytes[0] == kSync) { return check_binary(bytes); }
  if (bytes[0] == '$') { return check_text(bytes); }
  return {FrameVerdict::no_header};
}

Result<VectornavData> parse_vectornav(ByteView frame) {
  if (frame[0] == kSync) { return parse_binary(frame); }
  return parse_text(frame);
}

}  // namespace picolo::inline v0
