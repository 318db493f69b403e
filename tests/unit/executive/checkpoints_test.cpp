// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/executive/checkpoints.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace picolo {
namespace {

struct Round {
  const char* name;
  std::uint32_t expected;
  std::vector<std::uint32_t> keys;
  bool complete;
};

class Checkpoints : public ::testing::TestWithParam<Round> {};

TEST_P(Checkpoints, GivenKeysOfARoundThenCompleteOnlyWhenAllPassedInOrder) {
  CheckpointMonitor monitor;
  monitor.begin(GetParam().expected);
  for (const std::uint32_t key : GetParam().keys) { monitor.pass(key); }
  EXPECT_EQ(monitor.complete(), GetParam().complete);
}

INSTANTIATE_TEST_SUITE_P(Rounds, Checkpoints,
                         ::testing::Values(Round{"All", 3, {0, 5, 9}, true},
                                           Round{"NoneExpected", 0, {}, true},
                                           Round{"Missing", 3, {0, 5}, false},
                                           Round{"Swapped", 3, {0, 9, 5}, false},
                                           Round{"Twice", 2, {4, 4}, false},
                                           Round{"TwiceButEnough", 2, {4, 4, 5}, false},
                                           Round{"TooMany", 2, {1, 2, 3}, false},
                                           Round{"BackToTheFirst", 3, {1, 2, 0, 3}, false}),
                         [](const auto& param) { return param.param.name; });

TEST(CheckpointMonitor, GivenNoRoundThenNothingIsComplete) {
  EXPECT_FALSE(CheckpointMonitor{}.complete());
}

TEST(CheckpointMonitor, GivenASpoiltRoundWhenTheNextBeginsThenItCanBeComplete) {
  CheckpointMonitor monitor;
  monitor.begin(1);
  monitor.spoil();
  monitor.pass(0);
  EXPECT_FALSE(monitor.complete());
  monitor.begin(1);
  monitor.pass(0);
  EXPECT_TRUE(monitor.complete());
}

}  // namespace
}  // namespace picolo
