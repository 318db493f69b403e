// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/plausibility.hpp"
#include "picolo/odometry/differential_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace picolo {
namespace {

constexpr Timestamp kStart{100s};
constexpr PlausibilityConfig kConfig{};
static_assert(kConfig.valid());

WheelTicks ticks(Duration since_start, std::int64_t left, std::int64_t right) {
  return {.stamp = kStart + since_start, .ticks = {left, right}};
}

/// 0.1 m wheels with 4096 counts: 3 m/s are 19557 counts a second, 195 and some in 10 ms.
struct WheelGateTest : ::testing::Test {
  WheelGate gate{kConfig, DifferentialDrive{}.encoder_scale()};
  bool pass(WheelTicks sample) { return gate.pass(sample); }
};

TEST_F(WheelGateTest, GivenSpeedsUpToTheLimitThenAllPass) {
  EXPECT_TRUE(pass(ticks(0ms, 1'000'000, -5)));
  EXPECT_TRUE(pass(ticks(10ms, 1'000'195, -200)));
  EXPECT_TRUE(pass(ticks(20ms, 1'000'000, -5)));
  EXPECT_EQ(gate.left_out(), 0U);
}

TEST_F(WheelGateTest, GivenEitherWheelBeyondTheLimitThenLeftOut) {
  EXPECT_TRUE(pass(ticks(0ms, 0, 0)));
  EXPECT_FALSE(pass(ticks(10ms, 300, 0)));
  EXPECT_FALSE(pass(ticks(10ms, 0, -300)));
  EXPECT_EQ(gate.left_out(), 2U);
  EXPECT_TRUE(pass(ticks(20ms, 300, 300))) << "15 counts a millisecond are 2.3 m/s";
}

TEST_F(WheelGateTest, GivenCountsThatWentElsewhereAndStayedThenARestart) {
  EXPECT_TRUE(pass(ticks(0ms, 0, 0)));
  int left_out = 0;
  WheelTicks sample = ticks(10ms, 1LL << 32, 0);
  while (!gate.pass(sample)) {
    ++left_out;
    sample = ticks(10ms + left_out * 10ms, (1LL << 32) + left_out, 0);
  }
  EXPECT_EQ(left_out, kConfig.max_left_out);
  EXPECT_TRUE(sample.restarted);
  WheelTicks next = ticks(100ms, (1LL << 32) + 50, 0);
  EXPECT_TRUE(gate.pass(next));
  EXPECT_FALSE(next.restarted);
}

TEST_F(WheelGateTest, GivenAnAnnouncedRestartThenAnyCountPasses) {
  EXPECT_TRUE(pass(ticks(0ms, 5'000'000, 5'000'000)));
  WheelTicks restart = ticks(10ms, 0, 0);
  restart.restarted = true;
  EXPECT_TRUE(pass(restart));
  EXPECT_TRUE(pass(ticks(20ms, 100, 100)));
}

TEST_F(WheelGateTest, GivenAStaleStampThenTheOdometryMayJudgeIt) {
  EXPECT_TRUE(pass(ticks(10ms, 0, 0)));
  EXPECT_TRUE(pass(ticks(10ms, 9999, 9999)));
  EXPECT_TRUE(pass(ticks(0ms, 9999, 9999)));
  EXPECT_TRUE(pass(ticks(20ms, 100, 100))) << "the stale ones are no base";
}

TEST_F(WheelGateTest, GivenAVeryLongSilenceThenNothingOverflows) {
  EXPECT_TRUE(pass(ticks(0ms, 0, 0)));
  EXPECT_TRUE(pass(ticks(24h, 19'000'000, 0))) << "after the longest time that counts, 1000 s";
}

/// Wheels and gyro that turn at given rates, sampled every 10 ms, the gyro `lag` behind.
struct TurnCheckTest : ::testing::Test {
  TurnCheck check{kConfig};
  int step = 0;

  /// Steps until they disagree, at most `steps`.
  template <typename Wheels, typename Gyro>
  int run(int steps, Wheels wheels_radps, Gyro gyro_radps, Duration lag = 0ms) {
    for (int i = 0; i < steps; ++i, ++step) {
      const Timestamp from = kStart + step * 10ms;
      const double t_s = 0.01 * step;
      check.add_gyro(from + 10ms - lag, static_cast<float>(gyro_radps(t_s)));
      check.add(
          {.from = from, .to = from + 10ms, .from_T_to = {0.005, 0.0, 0.01 * wheels_radps(t_s)}});
      if (check.disagrees()) { return i; }
    }
    return steps;
  }
};

TEST_F(TurnCheckTest, GivenTheSameTurnsThenTheyAgreeEvenWithALag) {
  const auto weave = [](double t) { return 0.8 * std::sin(3.0 * t); };
  EXPECT_EQ(run(1000, weave, weave), 1000);
  EXPECT_EQ(run(1000, weave, weave, 9ms), 1000);
}

TEST_F(TurnCheckTest, GivenSlipOfAPercentAndBiasThenTheyAgree) {
  EXPECT_EQ(run(
                1000, [](double) { return 0.8; }, [](double) { return 0.785; }),
            1000);
}

TEST_F(TurnCheckTest, GivenAFrozenEncoderThenTheyDisagreeWithinHalfASweep) {
  EXPECT_LT(run(
                1000, [](double) { return 1.2; }, [](double) { return 0.0; }),
            5);
}

TEST_F(TurnCheckTest, GivenAFrozenGyroThenTheyDisagreeBeforeTheHeadingIsOffByThreeDegrees) {
  const int steps = run(
      1000, [](double) { return 0.5; }, [](double) { return 0.0; });
  EXPECT_LT(steps * 0.01 * 0.5, 0.052);
  EXPECT_TRUE(check.disagrees());
}

TEST_F(TurnCheckTest, GivenTheyAgreeAgainThenTheDifferenceIsForgotten) {
  ASSERT_LT(run(
                100, [](double) { return 1.0; }, [](double) { return 0.0; }),
            100);
  for (int i = 0; i < 60; ++i) {
    (void)run(
        1, [](double) { return 0.0; }, [](double) { return 0.0; });
  }
  EXPECT_FALSE(check.disagrees());
}

TEST_F(TurnCheckTest, GivenASilentGyroThenNoJudgement) {
  ASSERT_LT(run(
                100, [](double) { return 1.0; }, [](double) { return 0.0; }),
            100);
  for (int i = 0; i < 10; ++i, ++step) {
    const Timestamp from = kStart + step * 10ms;
    check.add({.from = from, .to = from + 10ms, .from_T_to = {0.0, 0.0, 0.01}});
  }
  EXPECT_FALSE(check.disagrees()) << "its silence is told elsewhere";
}

TEST_F(TurnCheckTest, GivenNoGyroAtAllThenNoJudgement) {
  check.add({.from = kStart, .to = kStart + 10ms, .from_T_to = {0.0, 0.0, 1.0}});
  EXPECT_FALSE(check.disagrees());
}

TEST_F(TurnCheckTest, GivenAGapOfTheWheelsThenItIsNotCompared) {
  (void)run(
      10, [](double) { return 0.0; }, [](double) { return 0.0; });
  const Timestamp from = kStart + step * 10ms;
  check.add_gyro(from + 500ms, 0.0F);
  check.add({.from = from, .to = from + 500ms, .from_T_to = {0.0, 0.0, 0.6}});
  EXPECT_FALSE(check.disagrees());
}

TEST(PlausibilityConfigTest, GivenLimitsOutOfTheirDomainThenRefused) {
  EXPECT_FALSE((PlausibilityConfig{.max_wheel_speed_mps = 0.0F}.valid()));
  EXPECT_FALSE((PlausibilityConfig{.max_left_out = -1}.valid()));
  EXPECT_FALSE((PlausibilityConfig{.max_turn_difference_rad = 0.0F}.valid()));
  EXPECT_FALSE((PlausibilityConfig{.turn_memory = 0us}.valid()));
  EXPECT_FALSE((PlausibilityConfig{.max_stamp_error = -1us}.valid()));
}

}  // namespace
}  // namespace picolo
