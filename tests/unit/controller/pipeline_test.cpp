// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/pipeline.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "small_profile.hpp"

namespace picolo {
namespace {

using test::beam;
using test::kBeams;
using test::kSweepPeriod;
using test::SmallProfile;
using test::ticks_at;

constexpr Timestamp kStart{5s};
constexpr std::size_t kAll = 1'000'000;

struct PipelineTest : ::testing::Test {
  static ControllerConfig configuration() {
    ControllerConfig config;
    config.undistort.limits.max_m = 12.0F;
    return config;
  }

  std::array<RangeReturn, kBeams> first{};
  std::array<RangeReturn, kBeams> second{};
  std::array<float, kBeams> x_m{};
  std::array<float, kBeams> y_m{};
  std::unique_ptr<Localiser<SmallProfile>> localiser = std::make_unique<Localiser<SmallProfile>>();
  ControllerConfig config = configuration();
  Pipeline pipeline{config, {first, second, x_m, y_m}, localiser->core()};

  /// Beams [from, to) of a lidar that stands still.
  void spin(int from, int to) {
    for (int i = from; i < to; ++i) { pipeline.add(beam(kStart, i, {})); }
  }
  /// Standing wheels, every 10 ms up to `end` since the start.
  void stand_until(Duration end) {
    for (; stood_ <= end; stood_ += 10ms) { pipeline.add(ticks_at(kStart + stood_, 1000, 1000)); }
  }
  /// Everything that can be done without further samples. True when a match ended.
  bool work() {
    pipeline.undistort(kAll);
    bool ended = false;
    for (int i = 0; i < 100 && !ended && pipeline.stage() == PipelineStage::matching; ++i) {
      ended = pipeline.match(kAll) || pipeline.search(kAll);
    }
    for (int i = 0; i < 100; ++i) { pipeline.map(kAll); }
    return ended;
  }

  Duration stood_{-20'000};
};

TEST_F(PipelineTest, GivenNoTicksThenTheNewestPoseIsTheOriginNow) {
  EXPECT_EQ(pipeline.newest_pose(kStart).stamp, kStart);
  EXPECT_EQ(pipeline.newest_pose(kStart).odom_T_base, Pose2d{});
}

TEST_F(PipelineTest, GivenTicksThenOdometryAdvancesFromTheFirstOnes) {
  pipeline.add(ticks_at(kStart, 100'000, 100'000));
  EXPECT_EQ(pipeline.newest_pose(kStart).stamp, kStart) << "a base, not a motion";
  pipeline.add(ticks_at(kStart + 1s, 104'096, 104'096));  // one turn of 0.1 m wheels
  const StampedPose pose = pipeline.newest_pose(kStart);
  EXPECT_EQ(pose.stamp, kStart + 1s);
  EXPECT_NEAR(pose.odom_T_base.x_m, 0.628318530718, 1e-9);
  EXPECT_EQ(pipeline.counters().increments, 1U);
}

TEST_F(PipelineTest, GivenTicksThatAreNotNewerThenTheyAreCountedAndIgnored) {
  pipeline.add(ticks_at(kStart + 10ms, 0, 0));
  pipeline.add(ticks_at(kStart + 10ms, 4096, 4096));
  pipeline.add(ticks_at(kStart, 4096, 4096));
  EXPECT_EQ(pipeline.counters().ticks_refused, 2U);
  EXPECT_EQ(pipeline.newest_pose(kStart).odom_T_base, Pose2d{});
}

TEST_F(PipelineTest, GivenCountersThatStartAnewAfterAMomentThenTheLastVelocityBridgesIt) {
  pipeline.add(ticks_at(kStart, 0, 0));
  pipeline.add(ticks_at(kStart + 10ms, 100, 100));
  const Pose2d before = pipeline.newest_pose(kStart).odom_T_base;
  WheelTicks restart = ticks_at(kStart + 40ms, 7777, 7777);
  restart.restarted = true;
  pipeline.add(restart);
  EXPECT_EQ(pipeline.newest_pose(kStart).stamp, kStart + 40ms);
  EXPECT_NEAR(pipeline.newest_pose(kStart).odom_T_base.x_m, 4.0 * before.x_m, 1e-6);
  EXPECT_EQ(pipeline.counters().bridged, 1U);
}

TEST_F(PipelineTest, GivenOneDamagedSampleThenItIsLeftOutAndTheNextCoversItsWay) {
  pipeline.add(ticks_at(kStart, 0, 0));
  pipeline.add(ticks_at(kStart + 10ms, 100, 100));
  pipeline.add(ticks_at(kStart + 20ms, 200 + 65536, 200));
  EXPECT_EQ(pipeline.counters().ticks_left_out, 1U);
  EXPECT_EQ(pipeline.newest_pose(kStart).stamp, kStart + 10ms);
  pipeline.add(ticks_at(kStart + 30ms, 300, 300));
  EXPECT_NEAR(pipeline.newest_pose(kStart).odom_T_base.x_m, 300 * 0.628318530718 / 4096, 1e-9);
}

TEST_F(PipelineTest, GivenAGyroThatTurnsWhileTheWheelsDoNotThenTheyDisagree) {
  for (int i = 0; i < 30; ++i) {
    ImuSample sample{.stamp = kStart + i * 10ms};
    sample.rate_radps[2] = 0.5F;
    pipeline.add(sample);
    pipeline.add(ticks_at(kStart + i * 10ms, 100 * i, 100 * i));
  }
  EXPECT_TRUE(pipeline.turns_disagree());
}

TEST_F(PipelineTest, GivenAHeldMapThenSweepsAreMatchedButNotRemembered) {
  stand_until(100ms);
  spin(0, kBeams + 1);
  ASSERT_TRUE(work());
  pipeline.hold_map(true);
  stand_until(300ms);
  spin(kBeams + 1, 2 * kBeams + 1);
  ASSERT_TRUE(work());
  EXPECT_TRUE(pipeline.verdict().accepted);
  EXPECT_EQ(pipeline.localiser().counters().inserted, 1U);
}

TEST_F(PipelineTest, GivenCountersThatStartAnewThenThePoseStandsThroughALongGap) {
  pipeline.add(ticks_at(kStart, 0, 0));
  pipeline.add(ticks_at(kStart + 10ms, 100, 100));
  const Pose2d before = pipeline.newest_pose(kStart).odom_T_base;
  WheelTicks restart = ticks_at(kStart + 500ms, 5, 5);
  restart.restarted = true;
  pipeline.add(restart);
  EXPECT_EQ(pipeline.newest_pose(kStart).stamp, kStart + 500ms);
  EXPECT_EQ(pipeline.newest_pose(kStart).odom_T_base, before);
  pipeline.add(ticks_at(kStart + 510ms, 105, 105));
  EXPECT_NEAR(pipeline.newest_pose(kStart).odom_T_base.x_m, 2.0 * before.x_m, 1e-12);
}

TEST_F(PipelineTest, GivenASweepThatOdometryDoesNotCoverYetThenItWaits) {
  stand_until(50ms);
  spin(0, kBeams + 1);  // the next revolution's first beam completes it
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.stage(), PipelineStage::undistorting);
  EXPECT_EQ(pipeline.last_sweep_end(), kStart + kSweepPeriod - 500us);
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.stage(), PipelineStage::undistorting);
  stand_until(100ms);
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.stage(), PipelineStage::matching);
  EXPECT_EQ(pipeline.counters().sweeps_taken, 1U);
}

TEST_F(PipelineTest, GivenAnUncoveredSweepWhenANewerOneIsCompleteThenItTakesItsPlace) {
  stand_until(50ms);
  spin(0, kBeams + 1);
  pipeline.undistort(kAll);
  spin(kBeams + 1, 2 * kBeams + 1);
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.counters().sweeps_replaced, 1U);
  stand_until(200ms);
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.stage(), PipelineStage::matching);
  ASSERT_TRUE(pipeline.match(kAll));
  EXPECT_EQ(pipeline.verdict().reference, kStart + 2 * kSweepPeriod - 500us);
}

TEST_F(PipelineTest, GivenASweepFromBeforeTheOldestPoseThenItIsDropped) {
  spin(0, kBeams + 1);
  stood_ = 50ms;
  stand_until(200ms);
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.stage(), PipelineStage::waiting);
  EXPECT_EQ(pipeline.counters().sweeps_uncovered, 1U);
}

TEST_F(PipelineTest, GivenTheFirstSweepThenItFoundsTheMapAndIsAccepted) {
  stand_until(100ms);
  spin(0, kBeams + 1);
  EXPECT_TRUE(work());
  EXPECT_TRUE(pipeline.verdict().accepted);
  EXPECT_EQ(pipeline.verdict().map_T_base, Pose2d{});
  EXPECT_EQ(pipeline.stage(), PipelineStage::waiting);
  EXPECT_EQ(pipeline.localiser().counters().inserted, 1U);
}

TEST_F(PipelineTest, GivenAStandingVehicleThenTheSecondSweepMatchesWhereItStands) {
  stand_until(100ms);
  spin(0, kBeams + 1);
  ASSERT_TRUE(work());
  stand_until(300ms);
  spin(kBeams + 1, 2 * kBeams + 1);
  ASSERT_TRUE(work());
  const MatchVerdict& verdict = pipeline.verdict();
  EXPECT_TRUE(verdict.accepted);
  EXPECT_EQ(verdict.rejection, HealthReason::none);
  EXPECT_EQ(verdict.reference, kStart + 2 * kSweepPeriod - 500us);
  EXPECT_EQ(verdict.odom_T_base, Pose2d{});
  EXPECT_NEAR(verdict.map_T_base.x_m, 0.0, 0.05);
  EXPECT_NEAR(verdict.map_T_base.y_m, 0.0, 0.05);
  EXPECT_GT(verdict.covariance(0, 0), 0.0F);
}

TEST_F(PipelineTest, GivenASweepOfNothingThenItIsRejectedForItsReason) {
  stand_until(100ms);
  spin(0, kBeams + 1);
  ASSERT_TRUE(work());
  stand_until(300ms);
  for (int i = kBeams + 1; i <= 2 * kBeams; ++i) {
    RangeReading empty = beam(kStart, i, {});
    empty.range_m = 0.0F;
    pipeline.add(empty);
  }
  ASSERT_TRUE(work());
  EXPECT_FALSE(pipeline.verdict().accepted);
  EXPECT_EQ(pipeline.verdict().rejection, HealthReason::too_few_points);
  EXPECT_EQ(pipeline.stage(), PipelineStage::waiting) << "it does not enter the map";
}

TEST_F(PipelineTest, GivenWorkBoundsThenEachSliceStaysWithinThem) {
  stand_until(100ms);
  spin(0, kBeams + 1);
  ASSERT_TRUE(work());
  stand_until(300ms);
  spin(kBeams + 1, 2 * kBeams + 1);
  int slices = 0;
  for (; pipeline.stage() != PipelineStage::matching; ++slices) { pipeline.undistort(50); }
  EXPECT_EQ(slices, 4) << "180 returns, 50 at a time";
  int iterations = 1;
  while (!pipeline.match(1)) { ++iterations; }
  EXPECT_GE(iterations, pipeline.localiser().report().iterations)
      << "a bound below one iteration still does one";
  int rays = 0;
  for (; pipeline.stage() == PipelineStage::mapping; ++rays) { pipeline.map(50); }
  EXPECT_GE(rays, 4);
}

TEST_F(PipelineTest, GivenAMatchUnderWayThenANewerSweepWaitsForItsEnd) {
  stand_until(300ms);
  spin(0, kBeams + 1);
  pipeline.undistort(kAll);
  ASSERT_EQ(pipeline.stage(), PipelineStage::matching);
  spin(kBeams + 1, 2 * kBeams + 1);
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.counters().sweeps_taken, 1U);
  ASSERT_TRUE(pipeline.match(kAll));
  for (int i = 0; i < 100; ++i) { pipeline.map(kAll); }
  pipeline.undistort(kAll);
  EXPECT_EQ(pipeline.counters().sweeps_taken, 2U);
}

}  // namespace
}  // namespace picolo
