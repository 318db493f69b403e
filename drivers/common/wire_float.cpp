// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/wire_float.hpp"

#include <bit>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint32_t kExponentOnes = 0xFF;
constexpr int kFloatBias = 127;
constexpr int kDoubleBias = 1023;
constexpr std::int64_t kIntegerLimit = std::int64_t{1} << 62;

}  // namespace

Result<float> float_from_bits(std::uint32_t bits) {
  if (((bits >> 23U) & kExponentOnes) == kExponentOnes) { return Status::corrupt; }
  return std::bit_cast<float>(bits);
}

Result<float> float_from_f64_bits(std::uint64_t bits) {
  const auto sign = static_cast<std::uint32_t>(bits >> 63U) << 31U;
  const int exponent = static_cast<int>((bits >> 52U) & 0x7FFU);
  if (exponent == 0x7FF) { return Status::corrupt; }
  const int shifted = exponent - kDoubleBias + kFloatBias;
  if (shifted <= 0) { return std::bit_cast<float>(sign); }
  const std::uint64_t mantissa = bits & 0xFFFFFFFFFFFFFULL;
  constexpr unsigned kDropped = 52 - 23;
  std::uint64_t kept = mantissa >> kDropped;
  const std::uint64_t rest = mantissa & ((1ULL << kDropped) - 1);
  const std::uint64_t half = 1ULL << (kDropped - 1);
  if (rest > half || (rest == half && (kept & 1U) != 0)) { ++kept; }  // may carry, which is right
  const std::uint64_t combined = (static_cast<std::uint64_t>(shifted) << 23U) + kept;
  if (combined >= (static_cast<std::uint64_t>(kExponentOnes) << 23U)) { return Status::corrupt; }
  return std::bit_cast<float>(sign | static_cast<std::uint32_t>(combined));
}

float float_from_fixed(std::int64_t value, unsigned fraction_bits) {
  return static_cast<float>(value) /
         static_cast<float>(std::int64_t{1} << static_cast<int>(fraction_bits));
}

Result<float> float_from_text(ByteView text) {
  constexpr std::int64_t kMaxMantissa = 100'000'000;
  std::size_t at = 0;
  bool negative = false;
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) {
    negative = text[0] == '-';
    ++at;
  }
  std::int64_t mantissa = 0;
  std::int64_t divisor = 1;
  bool any = false;
  bool point = false;
  for (; at < text.size(); ++at) {
    if (text[at] == '.' && !point) {
      point = true;
      continue;
    }
    if (text[at] < '0' || text[at] > '9') { return Status::corrupt; }
    any = true;
    if (mantissa >= kMaxMantissa) {
      if (!point) { return Status::corrupt; }
      continue;  // digits that no float could keep
    }
    mantissa = mantissa * 10 + (text[at] - '0');
    if (point) { divisor *= 10; }
  }
  if (!any) { return Status::corrupt; }
  const float value = static_cast<float>(mantissa) / static_cast<float>(divisor);
  return negative ? -value : value;
}

Result<std::int64_t> scaled_integer(std::uint32_t float_bits, std::uint32_t scale) {
  const std::uint32_t exponent_bits = (float_bits >> 23U) & kExponentOnes;
  if (exponent_bits == kExponentOnes) { return Status::corrupt; }
  if (exponent_bits == 0) { return std::int64_t{0}; }
  const auto mantissa = static_cast<std::int64_t>((float_bits & 0x7FFFFFU) | 0x800000U);
  const std::int64_t product = mantissa * static_cast<std::int64_t>(scale);  // below 2^56
  const int exponent = static_cast<int>(exponent_bits) - kFloatBias - 23;
  std::int64_t magnitude = 0;
  if (exponent >= 0) {
    if (exponent > 61 || product > (kIntegerLimit >> exponent)) { return Status::corrupt; }
    magnitude = product << exponent;
  } else if (exponent > -62) {
    const std::int64_t half = std::int64_t{1} << (-exponent - 1);
    magnitude = (product + half) >> -exponent;
  }
  return (float_bits >> 31U) != 0 ? -magnitude : magnitude;
}

}  // namespace picolo::inline v0
