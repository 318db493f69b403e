// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/hash.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace picolo {
namespace {

std::uint64_t hash_of(std::string_view text) {
  const std::vector<std::uint8_t> bytes{text.begin(), text.end()};
  Hash hash;
  hash.add_bytes(bytes);
  return hash.value();
}

template <typename T>
std::uint64_t hash_of_value(T value) {
  Hash hash;
  hash.add(value);
  return hash.value();
}

TEST(Hash, GivesThePublishedValuesOfFnv1a) {
  EXPECT_EQ(hash_of(""), 0xCBF29CE484222325ULL);
  EXPECT_EQ(hash_of("a"), 0xAF63DC4C8601EC8CULL);
  EXPECT_EQ(hash_of("foobar"), 0x85944171F73967E8ULL);
}

TEST(Hash, WordsEnterLeastSignificantByteFirst) {
  constexpr std::array<std::uint8_t, 4> kBytes{0x78, 0x56, 0x34, 0x12};
  Hash bytes;
  bytes.add_bytes(kBytes);
  EXPECT_EQ(hash_of_value(std::uint32_t{0x12345678}), bytes.value());
  EXPECT_EQ(hash_of_value(std::int64_t{-1}), hash_of_value(~std::uint64_t{0}));
  EXPECT_NE(hash_of_value(std::uint32_t{1}), hash_of_value(std::uint64_t{1}));
}

TEST(Hash, FloatsEnterAsTheirBits) {
  EXPECT_EQ(hash_of_value(1.5F), hash_of_value(std::bit_cast<std::uint32_t>(1.5F)));
  EXPECT_EQ(hash_of_value(1.5), hash_of_value(std::bit_cast<std::uint64_t>(1.5)));
  EXPECT_NE(hash_of_value(1.0F), hash_of_value(std::bit_cast<float>(0x3F800001U)));
}

TEST(Hash, MinusZeroIsZero) {
  EXPECT_EQ(hash_of_value(-0.0F), hash_of_value(0.0F));
  EXPECT_EQ(hash_of_value(-0.0), hash_of_value(0.0));
}

TEST(Hash, ANanPoisonsForGood) {
  Hash hash;
  hash.add(std::numeric_limits<float>::infinity());
  EXPECT_FALSE(hash.poisoned());
  hash.add(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(hash.poisoned());
  hash.add(1.0);
  EXPECT_TRUE(hash.poisoned());
  Hash wide;
  wide.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(wide.poisoned());
}

TEST(Hash, OrderMatters) {
  Hash ab;
  ab.add(1.0F);
  ab.add(2.0F);
  Hash ba;
  ba.add(2.0F);
  ba.add(1.0F);
  EXPECT_NE(ab.value(), ba.value());
}

}  // namespace
}  // namespace picolo
