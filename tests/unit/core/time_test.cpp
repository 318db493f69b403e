// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

TEST(Time, InstantsAndDifferencesAreDifferentTypes) {
  static_assert(!std::is_convertible_v<Duration, Timestamp>);
  static_assert(!std::is_convertible_v<Timestamp, Duration>);
  static_assert(std::is_same_v<decltype(Timestamp{} - Timestamp{}), Duration>);
  static_assert(std::is_trivially_copyable_v<Timestamp>);
  EXPECT_EQ((Timestamp{5ms} - Timestamp{2ms}).count(), 3000);
}

TEST(Time, SecondsAsFloatAreWithinAMicrosecondUpToEightSeconds) {
  for (std::int64_t us = 0; us <= 8'000'000; us += 997) {
    const double error_us =
        static_cast<double>(to_seconds(Duration{us})) * 1e6 - static_cast<double>(us);
    ASSERT_LE(std::abs(error_us), 1.0) << us;
  }
}

TEST(Time, SecondsAsDoubleGoThereAndBack) {
  Random random{5};
  for (int i = 0; i < 10000; ++i) {
    const auto us = static_cast<std::int64_t>(random.next_u32()) * 4096 - (std::int64_t{1} << 43);
    ASSERT_EQ(from_seconds(to_seconds_f64(Duration{us})), Duration{us});
  }
  EXPECT_EQ(from_seconds(1'234'567'890.123456), Duration{1'234'567'890'123'456});
}

TEST(Time, SecondsAreRoundedToTheNearestMicrosecond) {
  EXPECT_EQ(from_seconds(0.1), 100ms);
  EXPECT_EQ(from_seconds(-0.1), -100ms);
  EXPECT_EQ(from_seconds(1.4e-6), Duration{1});
  EXPECT_EQ(from_seconds(1.6e-6), Duration{2});
  EXPECT_EQ(from_seconds(-1.6e-6), Duration{-2});
}

TEST(Time, WhatIsNoTimeSaturatesOrIsZero) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(from_seconds(std::numeric_limits<double>::quiet_NaN()), Duration{0});
  EXPECT_EQ(from_seconds(infinity), Duration{std::int64_t{1} << 62});
  EXPECT_EQ(from_seconds(-infinity), Duration{-(std::int64_t{1} << 62)});
  EXPECT_EQ(from_seconds(1e300), Duration{std::int64_t{1} << 62});
  // The difference of two saturated times still fits.
  EXPECT_GT(from_seconds(infinity) - from_seconds(1.0), Duration{0});
}

}  // namespace
}  // namespace picolo
