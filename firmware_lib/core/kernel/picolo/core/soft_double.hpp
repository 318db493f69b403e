// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Double-precision sum, square root and conversions in integer arithmetic, rounded to nearest even
/// as IEEE 754-2008 asks, for processors without double-precision hardware. Every NaN is the same
/// one.
#pragma once

#include <bit>
#include <cstdint>

namespace picolo::inline v0::soft_double {

inline constexpr std::uint64_t kSign = 1ULL << 63;
inline constexpr std::uint64_t kHidden = 1ULL << 52;
inline constexpr std::uint64_t kInfinity = 0x7FFULL << 52;
inline constexpr std::uint64_t kNan = 0xFFFULL << 51;

/// A number whose mantissa has its leading bit at 55: 52 + 3 bits below it, the last of them
/// sticky. Smaller mantissas belong to exponent 1 only.
struct Unrounded {
  std::uint64_t sign;
  std::int32_t exponent;
  std::uint64_t mantissa;
};

[[nodiscard]] constexpr std::uint64_t shifted_right_sticky(std::uint64_t m, std::int32_t bits) {
  if (bits == 0) { return m; }
  if (bits > 63) { return m != 0 ? 1 : 0; }
  return (m >> bits) | ((m << (64 - bits)) != 0 ? 1U : 0U);
}

[[nodiscard]] constexpr std::uint64_t rounded(const Unrounded& x) {
  const std::uint64_t tail = x.mantissa & 7U;
  std::uint64_t m = x.mantissa >> 3;
  if (tail > 4U || (tail == 4U && (m & 1U) != 0)) { ++m; }
  // The hidden bit, and a carry out of the mantissa, count the exponent up by themselves.
  const std::uint64_t packed = (static_cast<std::uint64_t>(x.exponent - 1) << 52) + m;
  return x.sign | (packed < kInfinity ? packed : kInfinity);
}

[[nodiscard]] constexpr Unrounded unpacked(std::uint64_t a) {
  const auto exponent = static_cast<std::int32_t>((a >> 52) & 0x7FFU);
  const std::uint64_t fraction = a & (kHidden - 1);
  return exponent == 0 ? Unrounded{a & kSign, 1, fraction << 3}
                       : Unrounded{a & kSign, exponent, (fraction | kHidden) << 3};
}

[[nodiscard]] constexpr std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
  if ((a & ~kSign) < (b & ~kSign)) {
    const std::uint64_t swapped = a;
    a = b;
    b = swapped;
  }
  if ((a & ~kSign) >= kInfinity) {
    const bool opposite_infinities = (a ^ b) == kSign;
    return (a & ~kSign) > kInfinity || opposite_infinities ? kNan : a;
  }
  const Unrounded large = unpacked(a);
  const Unrounded small = unpacked(b);
  const std::uint64_t aligned =
      shifted_right_sticky(small.mantissa, large.exponent - small.exponent);
  if (large.sign == small.sign) {
    const std::uint64_t m = large.mantissa + aligned;
    return (m >> 56) != 0 ? rounded({large.sign, large.exponent + 1, shifted_right_sticky(m, 1)})
                          : rounded({large.sign, large.exponent, m});
  }
  const std::uint64_t m = large.mantissa - aligned;
  if (m == 0) { return 0; }
  const std::int32_t wanted = std::countl_zero(m) - 8;
  const std::int32_t shift = wanted < large.exponent ? wanted : large.exponent - 1;
  return rounded({large.sign, large.exponent - shift, m << shift});
}

[[nodiscard]] constexpr std::uint64_t from_u64(std::uint64_t value, std::uint64_t sign = 0) {
  if (value == 0) { return 0; }
  const std::int32_t shift = std::countl_zero(value) - 8;  // to bit 55
  const std::uint64_t m = shift >= 0 ? value << shift : shifted_right_sticky(value, -shift);
  return rounded({sign, 1023 + 55 - shift, m});
}

[[nodiscard]] constexpr std::uint64_t from_i64(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  return value < 0 ? from_u64(~bits + 1, kSign) : from_u64(bits);
}

[[nodiscard]] constexpr std::uint64_t from_float(std::uint32_t a) {
  const std::uint64_t sign = static_cast<std::uint64_t>(a >> 31) << 63;
  const std::uint32_t exponent = (a >> 23) & 0xFFU;
  const std::uint32_t fraction = a & 0x7FFFFFU;
  if (exponent == 0xFFU) { return fraction != 0 ? kNan : sign | kInfinity; }
  if (exponent != 0) {
    return sign | (static_cast<std::uint64_t>(exponent + 896U) << 52) |
           (static_cast<std::uint64_t>(fraction) << 29);
  }
  if (fraction == 0) { return sign; }
  // fraction * 2^-149
  return from_u64(fraction, sign) - (149ULL << 52);
}

[[nodiscard]] constexpr std::uint64_t square_root(std::uint64_t a) {
  if ((a & ~kSign) == 0) { return a; }
  if ((a & ~kSign) > kInfinity || (a & kSign) != 0) { return kNan; }
  if (a == kInfinity) { return a; }
  auto exponent = static_cast<std::int32_t>(a >> 52) - 1023;
  std::uint64_t m = a & (kHidden - 1);
  if (exponent == -1023) {
    const std::int32_t shift = std::countl_zero(m) - 11;
    m <<= shift;
    exponent = -1022 - shift;
  }
  m |= kHidden;
  if ((exponent & 1) != 0) {
    m <<= 1;
    --exponent;
  }
  // Digit by digit: 54 binary digits of the root of m * 2^54. The last one rounds; a tie cannot be.
  std::uint64_t root = 0;
  std::uint64_t rest = 0;
  m <<= 10;
  for (int digit = 0; digit < 54; ++digit) {
    rest = (rest << 2) | (m >> 62);
    m <<= 2;
    const std::uint64_t trial = (root << 2) | 1U;
    root <<= 1;
    if (rest >= trial) {
      rest -= trial;
      root |= 1U;
    }
  }
  const std::uint64_t mantissa = (root >> 1) + (root & 1U);
  return (static_cast<std::uint64_t>(exponent / 2 + 1022) << 52) + mantissa;
}

}  // namespace picolo::inline v0::soft_double
