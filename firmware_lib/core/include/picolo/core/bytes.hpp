// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Integers from and to bytes, and differences of counters that wrap. No casts of pointers
/// anywhere.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace picolo::inline v0 {

using ByteView = std::span<const std::uint8_t>;

// Precondition of all loads and stores: `offset + size <= bytes.size()`; the caller has checked the
// length.

[[nodiscard]] constexpr std::uint16_t load_u16_le(ByteView bytes, std::size_t offset) {
  return static_cast<std::uint16_t>(bytes[offset] | (bytes[offset + 1] << 8));
}
[[nodiscard]] constexpr std::uint16_t load_u16_be(ByteView bytes, std::size_t offset) {
  return static_cast<std::uint16_t>((bytes[offset] << 8) | bytes[offset + 1]);
}
[[nodiscard]] constexpr std::uint32_t load_u32_le(ByteView bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(load_u16_le(bytes, offset)) |
         (static_cast<std::uint32_t>(load_u16_le(bytes, offset + 2)) << 16);
}
[[nodiscard]] constexpr std::uint32_t load_u32_be(ByteView bytes, std::size_t offset) {
  return (static_cast<std::uint32_t>(load_u16_be(bytes, offset)) << 16) |
         load_u16_be(bytes, offset + 2);
}
[[nodiscard]] constexpr std::int16_t load_i16_le(ByteView bytes, std::size_t offset) {
  return std::bit_cast<std::int16_t>(load_u16_le(bytes, offset));
}
[[nodiscard]] constexpr std::int32_t load_i32_le(ByteView bytes, std::size_t offset) {
  return std::bit_cast<std::int32_t>(load_u32_le(bytes, offset));
}
[[nodiscard]] constexpr std::int32_t load_i32_be(ByteView bytes, std::size_t offset) {
  return std::bit_cast<std::int32_t>(load_u32_be(bytes, offset));
}

constexpr void store_u16_le(std::span<std::uint8_t> bytes, std::size_t offset,
                            std::uint16_t value) {
  bytes[offset] = static_cast<std::uint8_t>(value & 0xFFU);
  bytes[offset + 1] = static_cast<std::uint8_t>(value >> 8);
}
constexpr void store_u32_le(std::span<std::uint8_t> bytes, std::size_t offset,
                            std::uint32_t value) {
  store_u16_le(bytes, offset, static_cast<std::uint16_t>(value & 0xFFFFU));
  store_u16_le(bytes, offset + 2, static_cast<std::uint16_t>(value >> 16));
}

/// Signed difference of two counters that wrap at 2^16.
[[nodiscard]] constexpr std::int32_t wrapped_difference(std::uint16_t now, std::uint16_t before) {
  return std::bit_cast<std::int16_t>(static_cast<std::uint16_t>(now - before));
}
/// Signed difference of two counters that wrap at 2^32.
[[nodiscard]] constexpr std::int32_t wrapped_difference(std::uint32_t now, std::uint32_t before) {
  return std::bit_cast<std::int32_t>(now - before);
}
/// Signed difference of two counters in [0, modulus), the shorter way round; modulus in 2..2^32.
/// Absolute encoders wrap at their total range, which need not be a power of two.
[[nodiscard]] constexpr std::int64_t wrapped_difference(std::uint32_t now, std::uint32_t before,
                                                        std::uint64_t modulus) {
  const auto range = static_cast<std::int64_t>(modulus);
  std::int64_t difference = static_cast<std::int64_t>(now) - static_cast<std::int64_t>(before);
  if (difference > range / 2) { difference -= range; }
  if (difference < -(range - 1) / 2) { difference += range; }
  return difference;
}

static_assert(wrapped_difference(std::uint16_t{5}, std::uint16_t{65530}) == 11);
static_assert(wrapped_difference(std::uint32_t{1}, std::uint32_t{0xFFFFFFFFU}) == 2);
static_assert(wrapped_difference(3U, 9997U, 10000U) == 6);
static_assert(wrapped_difference(9997U, 3U, 10000U) == -6);

}  // namespace picolo::inline v0
