// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/sensor_checks.hpp"
#include "picolo/odometry/differential_drive.hpp"

#include <gtest/gtest.h>

#include <array>

namespace picolo {
namespace {

constexpr Timestamp kStart{100s};
constexpr PlausibilityConfig kConfig{};
constexpr SensorDoubts kLeft = doubt_of(SensorIndex::left_wheel);
constexpr SensorDoubts kRight = doubt_of(SensorIndex::right_wheel);

/// Wheels of 0.1 m with 4096 counts: 65 counts in 10 ms are 1 m/s.
struct WheelStepCheckTest : ::testing::Test {
  WheelStepCheck check{kConfig, DifferentialDrive{}.encoder_scale()};
  WheelTicks ticks{.stamp = kStart};
  SensorDoubts drive(int left, int right, Duration step = 10ms) {
    ticks.stamp += step;
    ticks.ticks[0] += left;
    ticks.ticks[1] += right;
    return check.add(ticks);
  }
};

TEST_F(WheelStepCheckTest, GivenAHardStartAndJitterOfStampsThenNoDoubt) {
  for (int speed = 0; speed < 60; speed += 5) { EXPECT_EQ(drive(speed, speed), 0); }
  EXPECT_EQ(drive(61, 61, 11ms), 0) << "the stamp is a millisecond late";
  EXPECT_EQ(drive(61, 61, 9ms), 0);
}

TEST_F(WheelStepCheckTest, GivenAWheelThatSticksThenItIsNamedAtOnce) {
  for (int i = 0; i < 5; ++i) { EXPECT_EQ(drive(30, 30), 0); }
  EXPECT_EQ(drive(30, 0), kRight);
  EXPECT_EQ(drive(30, 0), 0) << "it stands: nothing changes any more";
  EXPECT_EQ(drive(0, 0), kLeft);
}

TEST_F(WheelStepCheckTest, GivenCountsInBunchesOrGapsThenOnlyBunchesAreDoubted) {
  for (int i = 0; i < 5; ++i) { EXPECT_EQ(drive(40, 40), 0); }
  EXPECT_EQ(drive(80, 80, 20ms), 0) << "a lost sample takes no way with it";
  EXPECT_EQ(drive(40, 40, 60ms), 0) << "too long ago to compare";
  EXPECT_EQ(drive(40, 40), 0);
  EXPECT_EQ(drive(0, 40), kLeft);
  EXPECT_EQ(drive(80, 40), kLeft);
}

TEST_F(WheelStepCheckTest, GivenARestartOrAStaleSampleThenNothingIsCompared) {
  for (int i = 0; i < 5; ++i) { EXPECT_EQ(drive(40, 40), 0); }
  EXPECT_EQ(drive(40, 0, 0ms), 0);
  ticks.restarted = true;
  EXPECT_EQ(drive(-100'000, 0), 0);
  ticks.restarted = false;
  EXPECT_EQ(drive(40, 40), 0);
}

struct GyroCheckTest : ::testing::Test {
  GyroCheck check{kConfig};
  ImuSample sample{.stamp = kStart};
  float turn_difference_rad = 0.01F;
  bool add(float z_radps, float x_radps = 0.0F, bool moving = true, Duration step = 10ms) {
    sample.stamp += step;
    sample.rate_radps = {x_radps, 0.0F, z_radps};
    return check.add(sample, moving, turn_difference_rad);
  }
};

TEST_F(GyroCheckTest, GivenOneThatRepeatsItselfWhileDrivingThenDoubtAfter150ms) {
  for (int i = 0; i < 15; ++i) { EXPECT_FALSE(add(0.2F)) << i; }
  EXPECT_TRUE(add(0.2F));
  EXPECT_FALSE(add(0.2F, 0.001F)) << "another axis lives";
}

TEST_F(GyroCheckTest, GivenACoarseOneThatAgreesWithTheWheelsThenRepetitionProvesNothing) {
  turn_difference_rad = 0.002F;
  for (int i = 0; i < 100; ++i) { EXPECT_FALSE(add(0.0F)) << i; }
  turn_difference_rad = -0.01F;
  EXPECT_TRUE(add(0.0F));
}

TEST_F(GyroCheckTest, GivenStandstillThenRepetitionProvesNothing) {
  for (int i = 0; i < 100; ++i) { EXPECT_FALSE(add(0.0F, 0.0F, false)); }
  EXPECT_FALSE(add(0.0F, 0.0F, true, 0ms)) << "stale";
}

TEST_F(GyroCheckTest, GivenALeapThenDoubtButNotAfterAGap) {
  EXPECT_FALSE(add(0.0F));
  EXPECT_FALSE(add(0.5F));
  EXPECT_TRUE(add(-0.2F));
  EXPECT_FALSE(add(3.0F, 0.0F, true, 100ms));
}

struct SweepCheckTest : ::testing::Test {
  SweepCheck check;
  void sweep(float offset_m, int returns = 100) {
    for (int k = 0; k < returns; ++k) {
      check.add({.stamp = kStart,
                 .range_m = 1.0F + offset_m + 0.01F * static_cast<float>(k),
                 .starts_sweep = k == 0});
    }
  }
};

TEST_F(SweepCheckTest, GivenTheSameRevolutionAgainThenItIsKnown) {
  sweep(0.0F);
  sweep(0.001F);
  sweep(0.001F);
  EXPECT_FALSE(check.repeats()) << "the second of the equal ones is not complete";
  check.add({.stamp = kStart, .starts_sweep = true});
  EXPECT_TRUE(check.repeats());
  sweep(0.001F);
  sweep(0.003F);
  sweep(0.0F);
  EXPECT_FALSE(check.repeats());
}

TEST_F(SweepCheckTest, GivenRevolutionsThatTellTheirEndThenRepetitionIsKnownThere) {
  sweep(0.001F);
  for (int turn = 0; turn < 2; ++turn) {
    sweep(0.0F);
    check.add({.stamp = kStart, .range_m = 2.0F, .ends_sweep = true});
    EXPECT_EQ(check.repeats(), turn == 1);
  }
  check.add({.stamp = kStart, .range_m = 1.0F, .starts_sweep = true});
  EXPECT_TRUE(check.repeats()) << "until the next one is complete";
}

TEST_F(SweepCheckTest, GivenRevolutionsWithoutReturnsThenThatIsSomethingElse) {
  sweep(0.0F, 5);
  sweep(0.0F, 5);
  sweep(0.0F, 5);
  EXPECT_FALSE(check.repeats());
}

struct GravityCheckTest : ::testing::Test {
  GravityCheck check{kConfig};
  ImuSample sample{.stamp = kStart};
  int count = 0;
  void add(std::array<float, 3> acceleration_mps2, bool moving, int samples) {
    for (int i = 0; i < samples; ++i) {
      sample.stamp += 10ms;
      sample.acceleration_mps2 = acceleration_mps2;
      sample.acceleration_mps2[0] += ++count % 2 == 0 ? 0.02F : -0.02F;  // noise
      check.add(sample, moving);
    }
  }
};

TEST_F(GravityCheckTest, GivenALeanOfElevenDegreesThenTiltedWithinHalfASecondAndBack) {
  add({0.1F, 0.0F, 9.8F}, false, 60);
  add({0.6F, 0.3F, 9.8F}, true, 100);
  EXPECT_FALSE(check.tilted()) << "that is driving";
  add({0.1F, 2.3F, 9.5F}, true, 100);
  EXPECT_TRUE(check.tilted());
  EXPECT_FALSE(check.doubtful());
  add({0.1F, 0.0F, 9.8F}, true, 100);
  EXPECT_FALSE(check.tilted());
}

TEST_F(GravityCheckTest, GivenNoStandstillYetThenNothingIsSaidOfTheTilt) {
  add({0.0F, 5.0F, 8.4F}, true, 200);
  EXPECT_FALSE(check.tilted());
}

TEST_F(GravityCheckTest, GivenNoGravityOrTwiceOfItThenDoubt) {
  add({0.0F, 0.0F, 9.8F}, false, 60);
  EXPECT_FALSE(check.doubtful());
  add({0.0F, 0.0F, 0.0F}, true, 60);
  EXPECT_TRUE(check.doubtful());
  EXPECT_FALSE(check.tilted()) << "who is in doubt says nothing";
  add({0.0F, 0.0F, 9.8F}, true, 300);
  EXPECT_FALSE(check.doubtful());
  add({0.0F, 0.0F, 14.0F}, true, 100);
  EXPECT_TRUE(check.doubtful());
}

TEST_F(GravityCheckTest, GivenTheSameBitsWhileDrivingThenDoubt) {
  add({0.0F, 0.0F, 9.8F}, true, 60);
  for (int i = 0; i < 16; ++i) {
    sample.stamp += 10ms;
    check.add(sample, true);
  }
  EXPECT_TRUE(check.doubtful());
  check.add(sample, true);
  EXPECT_TRUE(check.doubtful()) << "a stale sample changes nothing";
}

TEST_F(GravityCheckTest, GivenAPushThenShakenAndGivenNoiseOfTensThenDoubt) {
  add({0.0F, 0.0F, 9.8F}, false, 60);
  EXPECT_FALSE(check.shaken());
  add({1.5F, 0.0F, 9.8F}, false, 1);
  EXPECT_TRUE(check.shaken());
  for (int i = 0; i < 60; ++i) { add({i % 2 == 0 ? 20.0F : -20.0F, 0.0F, 9.8F}, true, 1); }
  EXPECT_TRUE(check.doubtful());
}

TEST(Doubts, EachSensorHasItsBit) {
  EXPECT_EQ(kLeft | kRight, 3);
  EXPECT_EQ(doubt_of(SensorIndex::accelerometer), 16);
}

}  // namespace
}  // namespace picolo
