// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Integer arithmetic against the machine's own.

#include "picolo/core/soft_double.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

std::uint64_t bits(double x) {
  return std::isnan(x) ? soft_double::kNan : std::bit_cast<std::uint64_t>(x);
}

/// Any pattern, and often exponents that are near one another.
struct Pairs {
  Random random{3};
  std::uint64_t word() {
    const std::uint64_t high = random.next_u32();
    return (high << 32) | random.next_u32();
  }
  std::array<std::uint64_t, 2> next() {
    const std::uint64_t a = word();
    std::uint64_t b = word();
    if (random.below(4) != 0) {
      const std::uint64_t exponent = ((a >> 52) & 0x7FFU) + random.below(140) - 70U;
      b = (b & ~soft_double::kInfinity) | ((exponent & 0x7FFU) << 52);
    }
    if (random.below(8) == 0) { b &= ~0U << random.below(32); }  // few digits: ties
    return {a, b};
  }
};

TEST(SoftDouble, SumsAsTheMachineDoes) {
  Pairs pairs;
  for (int i = 0; i < 300'000; ++i) {
    const auto [a, b] = pairs.next();
    const double wanted = std::bit_cast<double>(a) + std::bit_cast<double>(b);
    ASSERT_EQ(soft_double::sum(a, b), bits(wanted)) << std::hex << a << " + " << b;
  }
}

TEST(SoftDouble, SumsWhereLibgccErrs) {
  const double p = std::bit_cast<double>(0x3de03a630440d9e1ULL);
  EXPECT_EQ(soft_double::sum(bits(1.0), bits(-p)), 0x3fefffffffefc59dULL);
}

TEST(SoftDouble, SumsZerosInfinitiesAndTheSmallestNumbers) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const double huge = std::numeric_limits<double>::max();
  for (const double a : {0.0, -0.0, tiny, -tiny, 1.0, -1.0, huge, -huge, infinity, -infinity,
                         std::nan(""), std::numeric_limits<double>::min()}) {
    for (const double b : {0.0, -0.0, tiny, -tiny, 1.0, -1.0, huge, -huge, infinity, -infinity,
                           std::nan(""), -std::numeric_limits<double>::min()}) {
      EXPECT_EQ(soft_double::sum(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)),
                bits(a + b))
          << a << " + " << b;
    }
  }
}

TEST(SoftDouble, TakesRootsAsTheMachineDoes) {
  Pairs pairs;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t a = pairs.word();
    ASSERT_EQ(soft_double::square_root(a), bits(std::sqrt(std::bit_cast<double>(a))));
    const std::uint64_t small = a & 0x000FFFFFFFFFFFFFULL;
    ASSERT_EQ(soft_double::square_root(small), bits(std::sqrt(std::bit_cast<double>(small))));
  }
  for (const double a : {0.0, -0.0, 1.0, 4.0, 2.0, std::numeric_limits<double>::infinity(), -1.0}) {
    EXPECT_EQ(soft_double::square_root(std::bit_cast<std::uint64_t>(a)), bits(std::sqrt(a))) << a;
  }
}

TEST(SoftDouble, ConvertsAsTheMachineDoes) {
  Pairs pairs;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t a = pairs.word() >> pairs.random.below(64);
    ASSERT_EQ(soft_double::from_u64(a), bits(static_cast<double>(a)));
    const auto s = std::bit_cast<std::int64_t>(a);
    ASSERT_EQ(soft_double::from_i64(s), bits(static_cast<double>(s)));
    const std::uint32_t f = pairs.random.next_u32();
    ASSERT_EQ(soft_double::from_float(f), bits(static_cast<double>(std::bit_cast<float>(f))));
    const std::uint32_t small = f & 0x807FFFFFU;
    ASSERT_EQ(soft_double::from_float(small),
              bits(static_cast<double>(std::bit_cast<float>(small))));
  }
  EXPECT_EQ(soft_double::from_i64(0), 0U);
  EXPECT_EQ(soft_double::from_i64(std::numeric_limits<std::int64_t>::min()), bits(-0x1p63));
}

}  // namespace
}  // namespace picolo
