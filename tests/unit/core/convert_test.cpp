// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Float to integer: exact for every value, the same on every processor.

#include "picolo/core/convert.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kMin64 = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMax64 = std::numeric_limits<std::int64_t>::max();

TEST(Convert, NotANumberGivesTheLowBound) {
  EXPECT_EQ(round_to_i32(kNan, -5, 5), -5);
  EXPECT_EQ(floor_to_i32(kNan, -5, 5), -5);
  EXPECT_EQ(floor_to_i32(static_cast<double>(kNan), 3, 5), 3);
  EXPECT_EQ(round_to_i64(static_cast<double>(kNan), 3, 5), 3);
}

TEST(Convert, InfinityAndWhatIsTooLargeGoToTheBounds) {
  for (const float value : {kInfinity, 3e38F, 2147483648.0F}) {
    EXPECT_EQ(round_to_i32(value, -5, 5), 5);
    EXPECT_EQ(round_to_i32(-value, -5, 5), -5);
    EXPECT_EQ(floor_to_i32(value, -5, 5), 5);
    EXPECT_EQ(floor_to_i32(-value, -5, 5), -5);
    EXPECT_EQ(floor_to_i32(static_cast<double>(value), INT32_MIN, INT32_MAX), INT32_MAX);
    EXPECT_EQ(floor_to_i32(static_cast<double>(-value), INT32_MIN, INT32_MAX), INT32_MIN);
  }
  EXPECT_EQ(round_to_i64(1e300, kMin64, kMax64), kMax64);
  EXPECT_EQ(round_to_i64(-1e300, kMin64, kMax64), kMin64);
  EXPECT_EQ(round_to_i64(0x1p63, kMin64, kMax64), kMax64);
  EXPECT_EQ(round_to_i64(-0x1p63, kMin64, kMax64), kMin64);
}

TEST(Convert, HalvesGoAwayFromZero) {
  EXPECT_EQ(round_to_i32(0.5F, -10, 10), 1);
  EXPECT_EQ(round_to_i32(-0.5F, -10, 10), -1);
  EXPECT_EQ(round_to_i32(1.5F, -10, 10), 2);
  EXPECT_EQ(round_to_i32(2.5F, -10, 10), 3);
  EXPECT_EQ(round_to_i32(-2.5F, -10, 10), -3);
  EXPECT_EQ(round_to_i32(-0.0F, -10, 10), 0);
  EXPECT_EQ(round_to_i64(4503599627370495.5, kMin64, kMax64), 4503599627370496);
}

TEST(Convert, WhatAddingAHalfWouldRoundWrongly) {
  EXPECT_EQ(round_to_i32(0.49999997F, -10, 10), 0);
  EXPECT_EQ(round_to_i32(-0.49999997F, -10, 10), 0);
  EXPECT_EQ(round_to_i32(8388609.0F, INT32_MIN, INT32_MAX), 8388609);
  EXPECT_EQ(round_to_i32(-8388609.0F, INT32_MIN, INT32_MAX), -8388609);
  EXPECT_EQ(round_to_i64(0.49999999999999994, -10, 10), 0);
  EXPECT_EQ(round_to_i64(4503599627370497.0, kMin64, kMax64), 4503599627370497);
}

TEST(Convert, FloorGoesDownAlsoBelowZero) {
  EXPECT_EQ(floor_to_i32(1.999F, -10, 10), 1);
  EXPECT_EQ(floor_to_i32(-0.001F, -10, 10), -1);
  EXPECT_EQ(floor_to_i32(-1.0F, -10, 10), -1);
  EXPECT_EQ(floor_to_i32(-1.001, -10, 10), -2);
  EXPECT_EQ(floor_to_i32(-0.0F, -10, 10), 0);
  EXPECT_EQ(floor_to_i32(-2147483647.5, INT32_MIN, INT32_MAX), INT32_MIN);
}

TEST(Convert, BoundsAreInclusiveAndNeedNotBeFloats) {
  EXPECT_EQ(round_to_i32(10.4F, -10, 10), 10);
  EXPECT_EQ(round_to_i32(10.6F, -10, 10), 10);
  EXPECT_EQ(round_to_i32(-10.6F, -10, 10), -10);
  EXPECT_EQ(floor_to_i32(-0.5F, 0, 10), 0);
  EXPECT_EQ(floor_to_i32(11.0F, 0, 10), 10);
  EXPECT_EQ(round_to_i32(7.0F, 3, 3), 3);
  // 16777217 has no float of its own.
  EXPECT_EQ(round_to_i32(16777216.0F, 0, 16777217), 16777216);
  EXPECT_EQ(round_to_i32(16777218.0F, 16777217, 16777300), 16777218);
  EXPECT_EQ(round_to_i32(2147483520.0F, 0, INT32_MAX), 2147483520);
}

TEST(Convert, AgreesWithTheStandardLibraryOnAnyBits) {
  Random random{17};
  for (int i = 0; i < 200000; ++i) {
    const auto value = std::bit_cast<float>(random.next_u32());
    const bool inside = value > -2147483648.0F && value < 2147483648.0F;
    if (!inside) { continue; }
    const auto wide = static_cast<double>(value);
    ASSERT_EQ(round_to_i32(value, INT32_MIN, INT32_MAX), std::llround(wide)) << value;
    ASSERT_EQ(floor_to_i32(value, INT32_MIN, INT32_MAX), std::floor(wide)) << value;
    ASSERT_EQ(floor_to_i32(wide, INT32_MIN, INT32_MAX), std::floor(wide)) << value;
    const double fine = wide * 1048576.0 + random.uniform_f64();
    ASSERT_EQ(round_to_i64(fine, kMin64, kMax64), std::llround(fine)) << fine;
  }
}

}  // namespace
}  // namespace picolo
