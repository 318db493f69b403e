// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Check values of the CRC catalogue (RevEng) over the nine digits, and the properties that users
// rely on.

#include "picolo/core/crc.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>

namespace picolo {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::array<std::uint8_t, 9> kDigits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};

TEST(Crc, CheckValuesOfTheCatalogue) {
  EXPECT_EQ(crc8(kDigits, 0x07), 0xF4);        // CRC-8/SMBUS
  EXPECT_EQ(crc8(kDigits, 0x31, 0xFF), 0xF7);  // CRC-8/NRSC-5
  EXPECT_EQ(crc8(kDigits, 0x2F, 0xFF), 0x20);  // CRC-8/AUTOSAR before its final exclusive-or, 0xDF
  EXPECT_EQ(crc16_ccitt(kDigits), 0x31C3);     // CRC-16/XMODEM
  EXPECT_EQ(crc16_ccitt(kDigits, 0xFFFF), 0x29B1);  // CRC-16/IBM-3740
  EXPECT_EQ(crc32(kDigits), 0xCBF43926U);           // CRC-32/ISO-HDLC
}

TEST(Crc, OfNothingIsTheStart) {
  EXPECT_EQ(crc8({}, 0x4D, 0x5A), 0x5A);
  EXPECT_EQ(crc16_ccitt({}, 0x1234), 0x1234);
  EXPECT_EQ(crc32({}), 0U);
}

TEST(Crc, Ld06TableOfTheMaker) {
  // First entries of the table that LDROBOT publishes: entry n is the CRC of the single byte n.
  constexpr std::array<std::uint8_t, 12> kTable{0x00, 0x4D, 0x9A, 0xD7, 0x79, 0x34,
                                                0xE3, 0xAE, 0xF2, 0xBF, 0x68, 0x25};
  for (std::uint8_t n = 0; n < kTable.size(); ++n) {
    EXPECT_EQ(crc8(Bytes{&n, 1}, 0x4D), kTable[n]) << int{n};
  }
}

TEST(Crc, Crc32ContinuesOverPieces) {
  for (std::size_t cut = 0; cut <= kDigits.size(); ++cut) {
    const Bytes whole{kDigits};
    EXPECT_EQ(crc32(whole.subspan(cut), crc32(whole.first(cut))), 0xCBF43926U);
  }
}

TEST(Crc, EverySingleAndDoubleBitErrorIsSeen) {
  const auto flipped = [](std::size_t a, std::size_t b) {
    std::array<std::uint8_t, 9> bytes = kDigits;
    bytes[a / 8] = static_cast<std::uint8_t>(bytes[a / 8] ^ (1U << (a % 8)));
    if (b != a) { bytes[b / 8] = static_cast<std::uint8_t>(bytes[b / 8] ^ (1U << (b % 8))); }
    return bytes;
  };
  for (std::size_t a = 0; a < 72; ++a) {
    for (std::size_t b = a; b < 72; ++b) {
      const auto bytes = flipped(a, b);
      ASSERT_NE(crc8(bytes, 0x07), 0xF4);
      ASSERT_NE(crc16_ccitt(bytes), 0x31C3);
      ASSERT_NE(crc32(bytes), 0xCBF43926U);
    }
  }
}

TEST(Sums, AddAndExclusiveOr) {
  EXPECT_EQ(sum8(kDigits), 0xDD);
  EXPECT_EQ(xor8(kDigits), 0x31);
  EXPECT_EQ(sum8({}), 0);
  EXPECT_EQ(xor8({}), 0);
  constexpr std::array<std::uint8_t, 3> kCarry{0xFF, 0xFF, 0x03};
  EXPECT_EQ(sum8(kCarry), 0x01);
}

}  // namespace
}  // namespace picolo
