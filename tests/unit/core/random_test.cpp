// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace picolo {
namespace {

TEST(Random, GivesTheReferenceSequenceOfPcg32) {
  // pcg32_demo of O'Neill's C library, seed 42, stream 54.
  Random random{42, 54};
  for (const std::uint32_t expected :
       {0xA15C02B7U, 0x7B47F409U, 0xBA1D3330U, 0x83D2F293U, 0xBFA4784BU, 0xCBED606EU}) {
    EXPECT_EQ(random.next_u32(), expected);
  }
}

TEST(Random, SameSeedSameNumbersOtherSeedOrStreamOtherNumbers) {
  Random a{7};
  Random b{7};
  Random other_seed{8};
  Random other_stream{7, 2};
  int equal_seed = 0;
  int equal_stream = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t value = a.next_u32();
    ASSERT_EQ(value, b.next_u32());
    equal_seed += value == other_seed.next_u32() ? 1 : 0;
    equal_stream += value == other_stream.next_u32() ? 1 : 0;
  }
  EXPECT_LE(equal_seed, 1);
  EXPECT_LE(equal_stream, 1);
}

TEST(Random, BelowStaysBelowAndReachesEveryValueEquallyOften) {
  Random random{3};
  std::array<int, 6> counts{};
  for (int i = 0; i < 60000; ++i) {
    const std::uint32_t face = random.below(6);
    ASSERT_LT(face, 6U);
    ++counts[face];
  }
  for (const int count : counts) { EXPECT_NEAR(count, 10000, 400); }  // 4 standard deviations
  EXPECT_EQ(random.below(0), 0U);
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, UniformIsInTheHalfOpenIntervalWithItsMoments) {
  Random random{4};
  constexpr int kCount = 100000;
  double sum_f32 = 0.0;
  double sum_f64 = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const float single = random.uniform_f32();
    ASSERT_GE(single, 0.0F);
    ASSERT_LT(single, 1.0F);
    const double wide = random.uniform_f64();
    ASSERT_GE(wide, 0.0);
    ASSERT_LT(wide, 1.0);
    sum_f32 += static_cast<double>(single);
    sum_f64 += wide;
    squares += wide * wide;
    const double scaled = random.uniform(-3.0, -1.0);
    ASSERT_GE(scaled, -3.0);
    ASSERT_LT(scaled, -1.0);
  }
  EXPECT_NEAR(sum_f32 / kCount, 0.5, 0.004);
  EXPECT_NEAR(sum_f64 / kCount, 0.5, 0.004);
  EXPECT_NEAR(squares / kCount, 1.0 / 3.0, 0.004);
}

TEST(Random, GaussianHasTheMomentsAndTailsOfTheNormalDistribution) {
  Random random{5};
  constexpr int kCount = 200000;
  double sum = 0.0;
  double squares = 0.0;
  double cubes = 0.0;
  double fourths = 0.0;
  int beyond_one = 0;
  int beyond_three = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.gaussian();
    sum += x;
    squares += x * x;
    cubes += x * x * x;
    fourths += x * x * x * x;
    beyond_one += std::abs(x) > 1.0 ? 1 : 0;
    beyond_three += std::abs(x) > 3.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.015);
  EXPECT_NEAR(cubes / kCount, 0.0, 0.04);
  EXPECT_NEAR(fourths / kCount, 3.0, 0.1);
  EXPECT_NEAR(static_cast<double>(beyond_one) / kCount, 0.3173, 0.005);
  EXPECT_NEAR(static_cast<double>(beyond_three) / kCount, 0.0027, 0.0005);
}

}  // namespace
}  // namespace picolo
