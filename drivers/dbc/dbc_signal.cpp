// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/dbc/dbc_signal.hpp"

#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/wire_float.hpp"

namespace picolo::inline v0 {
namespace {

std::uint8_t sum_with_id(std::uint32_t id, ByteView data, std::size_t skip) {
  std::uint32_t sum = (id >> 24U) + (id >> 16U) + (id >> 8U) + id;
  for (std::size_t i = 0; i < data.size(); ++i) { sum += i == skip ? 0U : data[i]; }
  return static_cast<std::uint8_t>(sum & 0xFFU);
}

std::uint8_t exclusive_or(ByteView data, std::size_t skip) {
  unsigned value = 0;
  for (std::size_t i = 0; i < data.size(); ++i) { value ^= i == skip ? 0U : data[i]; }
  return static_cast<std::uint8_t>(value);
}

std::uint8_t crc8_backwards(ByteView data, std::size_t skip) {
  unsigned crc = 0xFF;
  for (std::size_t i = data.size(); i > 0; --i) {
    if (i - 1 == skip) { continue; }
    crc ^= data[i - 1];
    for (int bit = 0; bit < 8; ++bit) {
      crc = ((crc & 0x80U) != 0 ? (crc << 1U) ^ 0xD5U : crc << 1U) & 0xFFU;
    }
  }
  return static_cast<std::uint8_t>(crc);
}

}  // namespace

Result<std::uint64_t> dbc_raw(const DbcSignal& signal, ByteView data) {
  if (data.size() < signal.needed_bytes()) { return Status::out_of_range; }
  std::uint64_t value = 0;
  std::size_t bit = signal.start_bit;
  for (std::size_t i = 0; i < signal.length; ++i) {
    const std::uint64_t one = (std::uint64_t{data[bit / 8]} >> (bit % 8)) & 1U;
    if (signal.big_endian) {
      value = (value << 1U) | one;
      bit = bit % 8 == 0 ? bit + 15 : bit - 1;  // on to the next byte's most significant bit
    } else {
      value |= one << i;
      ++bit;
    }
  }
  return value;
}

Result<std::int64_t> dbc_integer(const DbcSignal& signal, ByteView data) {
  if (signal.type != DbcType::unsigned_integer && signal.type != DbcType::signed_integer) {
    return Status::unsupported;
  }
  const Result<std::uint64_t> raw = dbc_raw(signal, data);
  if (!raw) { return raw.status(); }
  if (signal.has_invalid && *raw == signal.invalid_raw) { return Status::not_ready; }
  std::uint64_t value = *raw;
  const bool negative = ((value >> (signal.length - 1U)) & 1U) != 0;
  if (signal.type == DbcType::signed_integer && negative && signal.length < 64) {
    value |= ~std::uint64_t{0} << signal.length;
  }
  return std::bit_cast<std::int64_t>(value);
}

Result<float> dbc_number(const DbcSignal& signal, ByteView data) {
  if (signal.type == DbcType::float32 || signal.type == DbcType::float64) {
    const Result<std::uint64_t> raw = dbc_raw(signal, data);
    if (!raw) { return raw.status(); }
    return signal.type == DbcType::float32 ? float_from_bits(static_cast<std::uint32_t>(*raw))
                                           : float_from_f64_bits(*raw);
  }
  const Result<std::int64_t> value = dbc_integer(signal, data);
  if (!value) { return value.status(); }
  return static_cast<float>(*value);
}

Status dbc_check(const DbcRules& rules, std::uint32_t id, ByteView data) {
  if (rules.checksum == DbcChecksum::none) { return Status::ok; }
  const std::size_t at = rules.checksum_byte;
  if (at >= data.size()) { return Status::checksum; }
  std::uint8_t expected = 0;
  switch (rules.checksum) {
    case DbcChecksum::none: return Status::ok;
    case DbcChecksum::sum_with_id: expected = sum_with_id(id, data, at); break;
    case DbcChecksum::exclusive_or: expected = exclusive_or(data, at); break;
    case DbcChecksum::crc8: expected = crc8_backwards(data, at); break;
  }
  return expected == data[at] ? Status::ok : Status::checksum;
}

}  // namespace picolo::inline v0
