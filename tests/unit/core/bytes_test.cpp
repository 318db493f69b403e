// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/bytes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace picolo {
namespace {

constexpr std::array<std::uint8_t, 6> kBytes{0x01, 0x80, 0xFF, 0x7F, 0xFE, 0x55};

TEST(Bytes, LoadsLittleEndian) {
  static_assert(load_u16_le(kBytes, 0) == 0x8001);
  static_assert(load_u16_le(kBytes, 4) == 0x55FE);
  static_assert(load_i16_le(kBytes, 0) == -32767);
  static_assert(load_u32_le(kBytes, 1) == 0xFE7FFF80U);
  static_assert(load_i32_le(kBytes, 1) == -25165952);
  EXPECT_EQ(load_i16_le(kBytes, 3), static_cast<std::int16_t>(0xFE7F));
}

TEST(Bytes, LoadsBigEndian) {
  static_assert(load_u16_be(kBytes, 0) == 0x0180);
  static_assert(load_u32_be(kBytes, 0) == 0x0180FF7FU);
  static_assert(load_i32_be(kBytes, 2) == -8389035);
  EXPECT_EQ(load_u32_be(kBytes, 2), 0xFF7FFE55U);
}

TEST(Bytes, StoresWhatItLoadsAndNothingBeside) {
  for (const std::uint32_t value : {0U, 1U, 0x80000000U, 0xFFFFFFFFU, 0x12345678U}) {
    std::array<std::uint8_t, 8> bytes{};
    bytes.fill(0xAA);
    store_u32_le(bytes, 2, value);
    EXPECT_EQ(load_u32_le(bytes, 2), value);
    EXPECT_EQ(bytes[1], 0xAA);
    EXPECT_EQ(bytes[6], 0xAA);
    store_u16_le(bytes, 3, static_cast<std::uint16_t>(value & 0xFFFFU));
    EXPECT_EQ(load_u16_le(bytes, 3), value & 0xFFFFU);
    EXPECT_EQ(bytes[5], static_cast<std::uint8_t>(value >> 24));
  }
}

TEST(WrappedDifference, OfSixteenBitsIsSignedAndShort) {
  static_assert(wrapped_difference(std::uint16_t{5}, std::uint16_t{65530}) == 11);
  static_assert(wrapped_difference(std::uint16_t{65530}, std::uint16_t{5}) == -11);
  static_assert(wrapped_difference(std::uint16_t{32767}, std::uint16_t{0}) == 32767);
  EXPECT_EQ(wrapped_difference(std::uint16_t{32768}, std::uint16_t{0}), -32768);
}

TEST(WrappedDifference, OfThirtyTwoBitsIsSignedAndShort) {
  static_assert(wrapped_difference(std::uint32_t{0}, std::uint32_t{0xFFFFFFFF}) == 1);
  static_assert(wrapped_difference(std::uint32_t{0xFFFFFFFF}, std::uint32_t{0}) == -1);
  EXPECT_EQ(wrapped_difference(std::uint32_t{0x80000000}, std::uint32_t{0}), INT32_MIN);
}

TEST(WrappedDifference, OfAnyModulusIsTheShorterWayRound) {
  for (std::uint64_t modulus = 2; modulus <= 33; ++modulus) {
    for (std::uint32_t before = 0; before < modulus; ++before) {
      for (std::uint32_t now = 0; now < modulus; ++now) {
        const std::int64_t difference = wrapped_difference(now, before, modulus);
        const auto range = static_cast<std::int64_t>(modulus);
        // It leads from before to now ...
        ASSERT_EQ((before + difference + range) % range, now) << before << " " << modulus;
        // ... by at most half a turn, and half a turn counts as forward.
        ASSERT_LE(2 * difference, range) << before << " " << now << " " << modulus;
        ASSERT_GT(2 * difference, -range) << before << " " << now << " " << modulus;
      }
    }
  }
}

TEST(WrappedDifference, OfTheLargestModulusAgreesWithThirtyTwoBits) {
  constexpr std::uint64_t kModulus = std::uint64_t{1} << 32;
  static_assert(wrapped_difference(3U, 0xFFFFFFFEU, kModulus) == 5);
  static_assert(wrapped_difference(0xFFFFFFFEU, 3U, kModulus) == -5);
  EXPECT_EQ(wrapped_difference(0x7FFFFFFFU, 0U, kModulus), 0x7FFFFFFF);
}

}  // namespace
}  // namespace picolo
