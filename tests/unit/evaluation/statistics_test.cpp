// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

TEST(Statistics, GivenKnownNumbersThenEveryFigureIsRight) {
  std::vector<double> errors{4, 1, 3, 2};
  const auto s = statistics_of(errors);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->count, 4U);
  EXPECT_DOUBLE_EQ(s->mean, 2.5);
  EXPECT_DOUBLE_EQ(s->median, 2.5);
  EXPECT_DOUBLE_EQ(s->min, 1);
  EXPECT_DOUBLE_EQ(s->max, 4);
  EXPECT_DOUBLE_EQ(s->sse, 30);
  EXPECT_DOUBLE_EQ(s->rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s->std, std::sqrt(1.25));
}

TEST(Statistics, GivenAnOddCountThenTheMedianIsTheMiddleError) {
  std::vector<double> errors{9, 1, 5};
  EXPECT_EQ(statistics_of(errors)->median, 5);
  std::vector<double> one{2};
  EXPECT_EQ(statistics_of(one)->median, 2);
  EXPECT_EQ(statistics_of(one)->std, 0);
}

TEST(Statistics, RefusesNothingAndNonsense) {
  EXPECT_EQ(statistics_of({}).status(), Status::invalid_argument);
  std::vector<double> nan{1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(statistics_of(nan).status(), Status::invalid_argument);
  std::vector<double> infinite{1, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(statistics_of(infinite).status(), Status::invalid_argument);
}

TEST(RunningStatistics, GivenTheSameErrorsThenItAgreesWithTheBatch) {
  Random random{3};
  RunningStatistics running;
  std::vector<double> errors;
  for (int i = 0; i < 1000; ++i) {
    errors.push_back(1e3 + random.gaussian());
    running.add(errors.back());
  }
  const auto batch = statistics_of(errors);
  const auto stream = running.report();
  ASSERT_TRUE(batch && stream);
  EXPECT_NEAR(stream->rmse, batch->rmse, 1e-9);
  EXPECT_NEAR(stream->mean, batch->mean, 1e-9);
  EXPECT_NEAR(stream->std, batch->std, 1e-9);
  EXPECT_EQ(stream->min, batch->min);
  EXPECT_EQ(stream->max, batch->max);
  EXPECT_EQ(stream->count, batch->count);
}

TEST(RunningStatistics, IsNotReadyBeforeTheFirstErrorAndCountsNonsense) {
  RunningStatistics running;
  EXPECT_EQ(running.report().status(), Status::not_ready);
  running.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(running.report().status(), Status::not_ready);
  running.add(-2.0);
  EXPECT_EQ(running.report()->max, -2.0);
  EXPECT_EQ(running.report()->min, -2.0);
  EXPECT_EQ(running.rejected(), 1U);
}

}  // namespace
}  // namespace picolo
