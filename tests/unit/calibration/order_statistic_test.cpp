// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/order_statistic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/property.hpp"

namespace picolo {
namespace {

double selected(const std::vector<double>& values, std::uint64_t index) {
  OrderStatistic statistic;
  statistic.select(index);
  int passes = 0;
  while (statistic.searching()) {
    for (const double value : values) { statistic.offer(value); }
    statistic.end_pass();
    ++passes;
  }
  EXPECT_LE(passes, 16);
  return statistic.value();
}

TEST(OrderStatistic, EqualsTheSortedValueAtEveryIndex) {
  const bool held = rc::check("non-negative values with repeats", [] {
    auto values = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(rc::gen::map(
        rc::gen::inRange(0, 400), [](int k) { return std::exp(0.1 * (k - 200)) * (k % 7); })));
    auto sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 0; k < sorted.size(); ++k) { RC_ASSERT(selected(values, k) == sorted[k]); }
  });
  EXPECT_TRUE(held);
}

TEST(OrderStatistic, BeyondTheEndIsInfinity) {
  EXPECT_EQ(selected({1.0, 2.0}, 2), std::numeric_limits<double>::infinity());
  EXPECT_EQ(selected({}, 0), std::numeric_limits<double>::infinity());
}

TEST(OrderStatistic, NegativeAndNanCountAsZero) {
  EXPECT_EQ(selected({-1.0, std::numeric_limits<double>::quiet_NaN(), 3.0}, 1), 0.0);
  EXPECT_EQ(selected({-1.0, std::numeric_limits<double>::quiet_NaN(), 3.0}, 2), 3.0);
}

}  // namespace
}  // namespace picolo
