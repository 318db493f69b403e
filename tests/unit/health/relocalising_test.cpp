// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The pose is not known, or not proven: what the state says meanwhile, and which row of matches
// ends it.

#include <gtest/gtest.h>

#include "picolo/localisation/health.hpp"
#include "picolo/localisation/pose_trust.hpp"

namespace picolo {
namespace {

using State = HealthState;
using Reason = HealthReason;

class Relocalising : public ::testing::Test {
 protected:
  /// Inputs without any cause, and a monitor that tracks.
  HealthInputs in{.lidar_age = 100ms,
                  .wheels_age = 10ms,
                  .gyro_age = 10ms,
                  .match_age = 150ms,
                  .accepted_streak = 100};
  HealthMonitor monitor{HealthConfig{}};
  Timestamp now{10s};

  void SetUp() override { expect(State::tracking, Reason::none); }
  void expect(State state, Reason reason) {
    now += 25ms;
    in.now = now;
    (void)monitor.update(in);
    EXPECT_STREQ(to_string(monitor.state()), to_string(state));
    EXPECT_STREQ(to_string(monitor.reason()), to_string(reason));
  }
  void move_away() {
    in.accepted_streak = 0;
    in.unproven = true;
    in.unverified = true;
    expect(State::relocalising, Reason::relocalising);
  }
};

TEST_F(Relocalising, FromTrackingAtOnceThenAmbiguousThenFoundAndDegraded) {
  move_away();
  in.ambiguous = true;
  expect(State::relocalising, Reason::ambiguous);
  in.ambiguous = false;
  in.unverified = false;
  expect(State::relocalising, Reason::relocalising);  // found, not yet proven
  in.accepted_streak = HealthConfig{}.relocalised_matches - 1;
  expect(State::relocalising, Reason::relocalising);
  in.unproven = false;
  in.accepted_streak = HealthConfig{}.relocalised_matches;
  expect(State::degraded, Reason::relocalising);
  for (int i = 0; i < 19; ++i) { expect(State::degraded, Reason::relocalising); }
  expect(State::tracking, Reason::none);  // after recover_after
}

TEST_F(Relocalising, WithoutLidarItIsLostUntilThereIsSomethingToSearchWith) {
  move_away();
  in.lidar_age = 1s;
  expect(State::relocalising, Reason::relocalising);  // the search at hand goes on
  in.unverified = false;
  expect(State::lost, Reason::lidar_silent);
  in.lidar_age = 100ms;
  in.relocalising = true;
  expect(State::relocalising, Reason::relocalising);
  in.match_age = 2s;
  in.wheels_age = 2s;
  in.relocalising = false;
  expect(State::lost, Reason::wheels_silent);
}

TEST_F(Relocalising, ItEndsInFaultAndFoundWithoutWheelsItIsDegraded) {
  move_away();
  in.unverified = false;
  in.unproven = false;
  in.accepted_streak = HealthConfig{}.relocalised_matches;
  in.wheels_age = 200ms;
  expect(State::degraded, Reason::wheels_silent);
  move_away();
  in.cycle_fault = true;
  expect(State::fault, Reason::overrun);
}

TEST_F(Relocalising, UnprovenAloneIsDegradedAndTooFewPointsAreNeverLost) {
  in.unproven = true;
  expect(State::degraded, Reason::unproven);
  in.unproven = false;
  in.accepted_streak = 0;
  in.rejected_streak = 10 * HealthConfig{}.lost_rejections;
  in.rejection = Reason::too_few_points;
  expect(State::degraded, Reason::too_few_points);
  in.rejection = Reason::match_rejected;
  expect(State::lost, Reason::match_rejected);
}

TEST_F(Relocalising, AtTheStartItIsInitialisingUntilTheStartIsProven) {
  monitor.reset();
  in.unproven = true;
  in.unverified = true;
  expect(State::initialising, Reason::relocalising);
  in.unverified = false;
  expect(State::initialising, Reason::unproven);
  in.unproven = false;
  expect(State::tracking, Reason::none);
}

class Trust : public ::testing::Test {
 protected:
  PoseTrust trust{MatchTrust{}};
  void matches(int count, float agreement) {
    for (int i = 0; i < count; ++i) {
      trust.matched({.accepted = true, .inlier_share = 0.9F, .agreement = agreement});
    }
  }
};

TEST_F(Trust, ALeapIsProvenByFiveGoodMatchesInARow) {
  matches(3, 0.95F);
  EXPECT_FALSE(trust.unproven());
  trust.matched({.accepted = true, .inlier_share = 0.9F, .agreement = 0.95F, .leapt = true});
  EXPECT_TRUE(trust.unproven());
  matches(4, 0.95F);
  matches(1, 0.84F);
  matches(4, 0.95F);
  EXPECT_TRUE(trust.unproven());
  matches(1, 0.95F);
  EXPECT_FALSE(trust.unproven());
}

TEST_F(Trust, ContradictionsCountAsRejectionsAndTwoOfThemMakeThePoseUnproven) {
  matches(3, 0.95F);
  matches(1, 0.49F);
  EXPECT_EQ(trust.rejected_streak(), 1);
  EXPECT_EQ(trust.accepted_streak(), 0);
  EXPECT_FALSE(trust.unproven());
  matches(1, 0.51F);
  EXPECT_EQ(trust.rejected_streak(), 0);
  matches(2, 0.49F);
  EXPECT_TRUE(trust.unproven());
}

}  // namespace
}  // namespace picolo
