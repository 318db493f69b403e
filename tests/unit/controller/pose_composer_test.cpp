// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/pose_composer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

constexpr Timestamp kStart{10s};
constexpr Twist2 kStanding{};

void expect_near(const Pose2d& a, const Pose2d& b, double tolerance = 1e-9) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(wrap_angle(a.theta_rad - b.theta_rad), 0.0, tolerance);
}

constexpr OdometryNoise kExactOdometry{0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F};

struct PoseComposerTest : ::testing::Test {
  ControllerConfig config{};
  [[nodiscard]] PoseComposer composer() const {
    PoseComposer made{config};
    made.start(kStart);
    return made;
  }
};

TEST_F(PoseComposerTest, GivenNoMatchThenTheStartPoseIsCarriedByOdometry) {
  config.start_map_T_base = {5.0, 6.0, 1.5707963267948966};
  PoseComposer made = composer();
  const PoseEstimate estimate =
      made.compose(kStart + 1s, {kStart + 1s, {2.0, 0.0, 0.0}}, kStanding);
  expect_near(estimate.map_T_base, {5.0, 8.0, 1.5707963267948966});
  EXPECT_EQ(estimate.stamp, kStart + 1s);
  EXPECT_EQ(estimate.match_age, 1s) << "counts from the start";
  EXPECT_EQ(estimate.matches, 0U);
}

TEST_F(PoseComposerTest, GivenOdometryFromAWhileAgoThenItsTwistCarriesItToNow) {
  PoseComposer made = composer();
  const Twist2 twist{1.0F, 0.0F, 0.5F};
  const PoseEstimate estimate = made.compose(kStart + 20ms, {kStart + 8ms, {1.0, 2.0, 0.3}}, twist);
  EXPECT_EQ(estimate.stamp, kStart + 20ms);
  expect_near(estimate.odom_T_base,
              Pose2d{1.0, 2.0, 0.3} * exp_se2(Tangent2<double>{0.012, 0.0, 0.006}));
  EXPECT_EQ(estimate.base_twist.omega_radps, 0.5F);
}

TEST_F(PoseComposerTest, GivenOdometryThatStoppedThenThePoseDoesNotRunAhead) {
  PoseComposer made = composer();
  const Twist2 twist{1.0F, 0.0F, 0.0F};
  const PoseEstimate estimate = made.compose(kStart + 3s, {kStart, {}}, twist);
  EXPECT_EQ(estimate.stamp, kStart + config.max_prediction);
  EXPECT_NEAR(estimate.odom_T_base.x_m, 0.025, 1e-9);
  const PoseEstimate early = made.compose(kStart, {kStart + 1ms, {}}, twist);
  EXPECT_EQ(early.stamp, kStart + 1ms)
      << "odometry newer than the frame's start is not turned back";
}

TEST_F(PoseComposerTest, GivenAMatchForAnInstantInThePastThenOdometrySinceIsKept) {
  PoseComposer made = composer();
  const Pose2d odom_at_match{3.0, 1.0, 0.7};
  const Pose2d odom_now{3.1, 1.1, 0.8};
  const Pose2d map_at_match{3.2, 0.9, 0.72};
  made.correct({.accepted = true,
                .reference = kStart + 1s,
                .odom_T_base = odom_at_match,
                .map_T_base = map_at_match},
               {kStart + 1080ms, odom_now});
  const PoseEstimate estimate =
      made.compose(kStart + 1080ms, {kStart + 1080ms, odom_now}, kStanding);
  expect_near(estimate.map_T_base, map_at_match * between(odom_at_match, odom_now));
  expect_near(estimate.odom_T_base, odom_now);
  EXPECT_EQ(estimate.match_age, 80ms);
  EXPECT_EQ(estimate.matches, 1U);
}

TEST_F(PoseComposerTest, GivenACorrectionThenTheJumpIsToldInBaseAndJudged) {
  PoseComposer made = composer();
  const Pose2d odometry{10.0, 0.0, 1.5707963267948966};  // facing along y
  made.correct(
      {.accepted = true, .odom_T_base = odometry, .map_T_base = {10.0, 0.06, 1.5707963267948966}},
      {kStart, odometry});
  const PoseEstimate estimate = made.compose(kStart, {kStart, odometry}, kStanding);
  EXPECT_NEAR(estimate.last_jump.x_m, 0.06, 1e-6) << "forward in base";
  EXPECT_NEAR(estimate.last_jump.y_m, 0.0, 1e-6);
  EXPECT_TRUE(made.correction().jumped);
  EXPECT_EQ(made.jump_mm(), 60);
  made.correct(
      {.accepted = true, .odom_T_base = odometry, .map_T_base = {10.0, 0.06, 1.5707963267948966}},
      {kStart, odometry});
  EXPECT_FALSE(made.correction().jumped) << "said the same again";
  made.correct(
      {.accepted = true, .odom_T_base = odometry, .map_T_base = {10.0, 0.06, 1.5307963267948966}},
      {kStart, odometry});
  EXPECT_TRUE(made.correction().jumped) << "turned by more than 0.035 rad";
}

TEST_F(PoseComposerTest, GivenCorrectionsThatKeepPointingTheSameWayThenAPull) {
  PoseComposer made = composer();
  double offset_m = 0.0;
  int matches = 0;
  for (; !made.correction().pulled && matches < 100; ++matches) {
    offset_m += 0.03;  // each below the limit of a jump
    made.correct({.accepted = true, .map_T_base = {offset_m, 0.0, 0.0}}, {kStart, {}});
    EXPECT_FALSE(made.correction().jumped);
  }
  EXPECT_EQ(matches, 3) << "0.03 m + 0.97 of what was before, beyond 0.07 m";
  for (int i = 0; i < 10; ++i) {
    made.correct({.accepted = true, .map_T_base = {offset_m, 0.0, 0.0}}, {kStart, {}});
  }
  EXPECT_FALSE(made.correction().pulled) << "it fades";
}

TEST_F(PoseComposerTest, GivenWheelsThatTurnAloneThenTurnsMayBeWrongerAndAreNotBelievedFurther) {
  PoseComposer made = composer();
  MatchVerdict verdict{.accepted = true, .turned_by_gyro = false};
  verdict.map_T_base = {0.0, 0.0, 0.06};
  made.correct(verdict, {kStart, {}});
  EXPECT_FALSE(made.correction().jumped) << "0.035 rad with a gyro";
  verdict.map_T_base = {0.0, 0.0, 0.16};
  made.correct(verdict, {kStart, {}});
  EXPECT_TRUE(made.correction().jumped);
  EXPECT_FALSE(made.turn_unverified(false));
  (void)made.compose(kStart + 100ms, {kStart + 100ms, {0.0, 0.0, 0.05}}, {});
  EXPECT_TRUE(made.turn_unverified(false));
  EXPECT_FALSE(made.turn_unverified(true));
}

TEST_F(PoseComposerTest, GivenAStraightWayByWheelsAloneThenItMayHideATurn) {
  PoseComposer made = composer();
  made.correct({.accepted = true, .turned_by_gyro = false}, {kStart, {}});
  (void)made.compose(kStart + 100ms, {kStart + 100ms, {0.09, 0.0, 0.0}}, {});
  EXPECT_FALSE(made.turn_unverified(false));
  (void)made.compose(kStart + 110ms, {kStart + 110ms, {0.11, 0.0, 0.0}}, {});
  EXPECT_TRUE(made.turn_unverified(false)) << "0.4 rad a metre, beyond 0.04 rad";
  made.correct({.accepted = true, .turned_by_gyro = false}, {kStart + 110ms, {0.11, 0.0, 0.0}});
  EXPECT_TRUE(made.turn_unverified(false)) << "a match for the place where it was at the start";
  (void)made.compose(kStart + 110ms, {kStart + 110ms, {0.11, 0.0, 0.0}}, {});
  EXPECT_FALSE(made.turn_unverified(true));
}

TEST_F(PoseComposerTest, GivenCorrectionsThatPointHereAndThereThenNoPull) {
  PoseComposer made = composer();
  for (int i = 0; i < 100; ++i) {
    const double offset_m = i % 2 == 0 ? 0.04 : 0.0;
    const double turn_rad = i % 2 == 0 ? 0.02 : -0.01;
    made.correct({.accepted = true, .map_T_base = {offset_m, 0.0, turn_rad}}, {kStart, {}});
    ASSERT_FALSE(made.correction().pulled);
  }
}

TEST_F(PoseComposerTest, GivenAHeadingErrorAtTheMatchThenItSwingsThePoseThatDroveOn) {
  // Against the sampled distribution: the heading at the match is off by 0.02 rad (sigma), the
  // vehicle drives 5 m since.
  config.localiser.uncertainty.odometry = kExactOdometry;
  PoseComposer made = composer();
  const Pose2d at_match{1.0, 2.0, 0.6};
  const Pose2d way{5.0, 0.4, 0.3};
  const Matrix3f covariance = Matrix3f::diagonal(1e-4F, 4e-4F, 4e-4F);
  made.correct(
      {.accepted = true, .odom_T_base = {}, .map_T_base = at_match, .covariance = covariance},
      {kStart, {}});
  const PoseEstimate estimate = made.compose(kStart, {kStart, way}, kStanding);

  Random random{5};
  Matrix3d sampled{};
  const Pose2d mean = at_match * way;
  constexpr int kSamples = 200'000;
  for (int i = 0; i < kSamples; ++i) {
    const double dx = 0.01 * random.gaussian();
    const double dy = 0.02 * random.gaussian();
    const double dtheta = 0.02 * random.gaussian();
    const Pose2d sample =
        Pose2d{at_match.x_m + dx, at_match.y_m + dy, at_match.theta_rad + dtheta} * way;
    const std::array<double, 3> error{sample.x_m - mean.x_m, sample.y_m - mean.y_m,
                                      wrap_angle(sample.theta_rad - mean.theta_rad)};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) { sampled(r, c) += error[r] * error[c] / kSamples; }
    }
  }
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(estimate.match_covariance.elements[i], sampled.elements[i], 2e-4)
        << "element " << i;
  }
}

TEST_F(PoseComposerTest, GivenAWayThereAndBackThenWhatWandersHasGrownAndAWrongScaleCancels) {
  config.localiser.uncertainty.odometry = kExactOdometry;
  OdometryNoise& noise = config.localiser.uncertainty.odometry;
  noise.walk_m = 0.01F;
  noise.walk_persists_m = 0.0F;
  noise.scale = 0.05F;
  PoseComposer made = composer();
  made.correct({.accepted = true, .covariance = Matrix3f::diagonal(1e-4F, 1e-4F, 1e-6F)},
               {kStart, {}});
  PoseEstimate estimate;
  for (int i = 1; i <= 40; ++i) {
    const double x_m = i <= 20 ? 0.1 * i : 0.1 * (40 - i);
    estimate = made.compose(kStart, {kStart, {x_m, 0.0, 0.0}}, kStanding);
    if (i == 20) {
      EXPECT_NEAR(estimate.match_covariance(0, 0), 1e-4 + 2e-4 + 0.1 * 0.1, 1e-6) << "5 % of 2 m";
    }
  }
  EXPECT_NEAR(estimate.match_covariance(0, 0), 1e-4 + 4e-4, 1e-6);
}

TEST_F(PoseComposerTest, GivenAMatchThenItsCovarianceStartsAnewAndTheMapsDriftIsCarriedAlong) {
  PoseComposer made = composer();
  const StampedPose after_10_m{kStart + 10s, {10.0, 0.0, 0.0}};
  const PoseEstimate before = made.compose(after_10_m.stamp, after_10_m, kStanding);
  EXPECT_GT(before.match_covariance(1, 1), 1e-4F);
  EXPECT_EQ(before.drift_covariance, Matrix3f{});
  made.correct({.accepted = true,
                .odom_T_base = after_10_m.odom_T_base,
                .map_T_base = after_10_m.odom_T_base,
                .covariance = Matrix3f::diagonal(1e-4F, 2e-4F, 1e-6F),
                .drift_covariance = Matrix3f::diagonal(4e-4F, 5e-4F, 1e-4F)},
               after_10_m);
  const StampedPose later{kStart + 11s, {12.0, 0.0, 0.0}};
  const PoseEstimate ahead = made.compose(later.stamp, later, kStanding);
  EXPECT_NEAR(ahead.drift_covariance(1, 1), 5e-4 + 1e-4 * 2.0 * 2.0, 1e-8) << "the lever of 2 m";
  EXPECT_LT(ahead.match_covariance(1, 1), before.match_covariance(1, 1));
}

}  // namespace
}  // namespace picolo
