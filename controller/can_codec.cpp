// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/can_codec.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/bytes.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kPolynomial = 0x1D;
constexpr std::size_t kLength = 8;

std::uint64_t mask_of(const CanField& field) {
  return (std::uint64_t{1} << field.bits) - 1;
}

std::uint64_t load_u64_le(const std::array<std::uint8_t, kLength>& data) {
  return std::uint64_t{load_u32_le(data, 0)} | (std::uint64_t{load_u32_le(data, 4)} << 32);
}

}  // namespace

std::int64_t to_raw(const CanField& field, double value) {
  const double scaled = value * static_cast<double>(field.per_unit);
  if (field.kind != CanKind::number) {
    constexpr std::int64_t kWide = std::int64_t{1} << 52;
    return round_to_i64(scaled, -kWide, kWide);
  }
  // One step further than what is allowed, so that clamping shows.
  const std::int64_t low = field.is_signed ? field.lowest() + 1 : field.lowest();
  const std::int64_t high = field.is_signed ? field.highest() : field.highest() - 1;
  const std::int64_t raw = round_to_i64(scaled, low - 1, high + 1);
  return raw < low || raw > high ? field.not_available() : raw;
}

double to_value(const CanField& field, std::int64_t raw) {
  if (field.kind == CanKind::number && raw == field.not_available()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return static_cast<double>(raw) / static_cast<double>(field.per_unit);
}

std::uint8_t frame_crc(const CanLayout& layout, std::span<const std::uint8_t> data) {
  const auto data_id = static_cast<std::uint16_t>(kCanDataIdBase + layout.offset);
  std::array<std::uint8_t, 2> head{};
  store_u16_le(head, 0, data_id);
  return crc8(data.subspan(1), kPolynomial, crc8(head, kPolynomial));
}

CanFrame encode(const CanLayout& layout, std::uint16_t base_id, std::uint8_t counter,
                std::span<const std::int64_t> raw) {
  std::uint64_t bits = std::uint64_t{static_cast<std::uint8_t>(counter % kCanCounterModulus)} << 8;
  const std::size_t count = std::min(raw.size(), std::size_t{layout.size});
  for (std::size_t i = 0; i < count; ++i) {
    const CanField& field = layout.fields[i];
    bits |= (static_cast<std::uint64_t>(raw[i]) & mask_of(field)) << field.start_bit;
  }
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(base_id + layout.offset);
  frame.length = kLength;
  store_u32_le(frame.data, 0, static_cast<std::uint32_t>(bits & 0xFFFF'FFFFU));
  store_u32_le(frame.data, 4, static_cast<std::uint32_t>(bits >> 32));
  frame.data[0] = frame_crc(layout, frame.data);
  return frame;
}

Result<CanValues> decode(const CanLayout& layout, std::uint16_t base_id, const CanFrame& frame) {
  const auto id = static_cast<std::uint32_t>(base_id + layout.offset);
  if (frame.id != id || frame.extended || frame.remote) { return Status::invalid_argument; }
  if (frame.length != kLength || frame.data[0] != frame_crc(layout, frame.data)) {
    return Status::checksum;
  }
  const std::uint64_t bits = load_u64_le(frame.data);
  CanValues values;
  values.counter = static_cast<std::uint8_t>((bits >> 8) & 0xFU);
  if (values.counter >= kCanCounterModulus) { return Status::checksum; }
  for (std::size_t i = 0; i < std::size_t{layout.size}; ++i) {
    const CanField& field = layout.fields[i];
    const auto raw = static_cast<std::int64_t>((bits >> field.start_bit) & mask_of(field));
    const bool negative = field.is_signed && raw > field.highest();
    values.raw[i] = negative ? raw - (std::int64_t{1} << field.bits) : raw;
  }
  return values;
}

}  // namespace picolo::inline v0
