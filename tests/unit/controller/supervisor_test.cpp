// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/supervisor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace picolo {
namespace {

constexpr MatchVerdict kGood{.accepted = true, .agreement = 0.95F, .inlier_share = 0.9F};
constexpr TaskTable<2> kTable{
    TaskEntry{.name = "first", .budget = 1ms},
    TaskEntry{.name = "second", .budget = 1ms, .policy = OverrunPolicy::fault}};

/// A supervisor whose devices all speak every 25 ms, with a schedule that runs in time unless told
/// otherwise.
struct SupervisorTest : ::testing::Test {
  EventRing ring{};
  Supervisor supervisor{HealthConfig{}, MatchTrust{}, ring};
  std::array<TaskState, 2> states{};
  Schedule schedule{ExecutiveConfig{}, kTable, states};
  Timestamp now{1min};
  PoseEstimate estimate{};

  void SetUp() override {
    ring.clear();
    ASSERT_EQ(schedule.start(now), Status::ok);
    supervisor.start(now, false);
  }
  void run_frame(Duration length_of_first = 10us, Duration length_of_second = 10us) {
    ASSERT_TRUE(schedule.begin_frame(now));
    for (std::size_t task = 0; task < 2; ++task) {
      ASSERT_TRUE(schedule.take(task));
      schedule.finish(task, task == 0 ? length_of_first : length_of_second, 0, true);
    }
    (void)schedule.end_frame(now);
  }
  void tick(bool lidar = true, bool wheels = true, bool imu = true) {
    now += 25ms;
    if (wheels) { supervisor.heard(DeviceIndex::wheels, now); }
    if (lidar) { supervisor.heard(DeviceIndex::lidar, now); }
    if (imu) { supervisor.heard(DeviceIndex::imu, now); }
    estimate.stamp = now;
    supervisor.update(now, estimate, schedule);
  }
  void track() {
    for (int i = 0; i < 3; ++i) { supervisor.matched(kGood); }
    tick();
    ASSERT_EQ(supervisor.state(), HealthState::tracking);
  }
  [[nodiscard]] std::vector<EventCode> codes() const {
    std::vector<EventCode> found;
    for (std::size_t i = 0; i < ring.size(); ++i) { found.push_back(ring[i].code); }
    return found;
  }
  [[nodiscard]] const Event& newest() const { return ring[ring.size() - 1]; }
};

TEST_F(SupervisorTest, GivenTheStartThenItIsTheFirstEvent) {
  ASSERT_EQ(ring.size(), 1U);
  EXPECT_EQ(ring[0].code, EventCode::started);
  EXPECT_EQ(ring[0].argument, 0);
  supervisor.start(now, true);
  EXPECT_EQ(newest().argument, 1) << "the ring came through a reset";
}

TEST_F(SupervisorTest, GivenAgesFromTheStartThenADeviceHasItsTimeToSpeak) {
  now += 100ms;
  estimate.stamp = now;
  supervisor.update(now, estimate, schedule);
  EXPECT_EQ(supervisor.reason(), HealthReason::starting);
}

TEST_F(SupervisorTest, GivenSilenceThenTheTransitionIsWrittenWithFromToAndReason) {
  track();
  for (int i = 0; i < 12; ++i) { tick(false); }
  EXPECT_EQ(supervisor.state(), HealthState::degraded);
  EXPECT_EQ(newest().code, EventCode::state_changed);
  EXPECT_EQ(newest().from, HealthState::tracking);
  EXPECT_EQ(newest().to, HealthState::degraded);
  EXPECT_EQ(newest().reason, HealthReason::lidar_silent);
}

TEST_F(SupervisorTest, GivenAnotherCauseInTheSameStateThenTheReasonChangeIsWritten) {
  track();
  for (int i = 0; i < 12; ++i) { tick(true, true, false); }
  ASSERT_EQ(supervisor.reason(), HealthReason::gyro_silent);
  for (int i = 0; i < 12; ++i) { tick(false, true, false); }
  EXPECT_EQ(newest().code, EventCode::reason_changed);
  EXPECT_EQ(newest().argument, static_cast<std::int32_t>(HealthReason::gyro_silent));
  EXPECT_EQ(newest().reason, HealthReason::lidar_silent);
}

TEST_F(SupervisorTest, GivenStampsOutOfOrderThenTheNewestCounts) {
  supervisor.heard(DeviceIndex::wheels, now + 1s);
  supervisor.heard(DeviceIndex::wheels, now + 500ms);
  supervisor.matched(kGood);
  supervisor.matched(kGood);
  supervisor.matched(kGood);
  supervisor.heard(DeviceIndex::lidar, now + 1s);
  supervisor.heard(DeviceIndex::imu, now + 1s);
  estimate.stamp = now + 1s;
  supervisor.update(now + 1s, estimate, schedule);
  EXPECT_EQ(supervisor.state(), HealthState::tracking);
}

TEST_F(SupervisorTest, GivenALineThatGoesAndComesThenEachIsOneEvent) {
  supervisor.line(DeviceIndex::lidar, Status::ok, now);
  supervisor.line(DeviceIndex::lidar, Status::not_ready, now);
  EXPECT_EQ(ring.size(), 1U) << "nothing happened";
  for (int i = 0; i < 5; ++i) { supervisor.line(DeviceIndex::lidar, Status::disconnected, now); }
  EXPECT_FALSE(supervisor.connected(DeviceIndex::lidar));
  EXPECT_TRUE(supervisor.connected(DeviceIndex::imu));
  for (int i = 0; i < 5; ++i) { supervisor.line(DeviceIndex::lidar, Status::not_ready, now); }
  EXPECT_EQ(codes(),
            (std::vector{EventCode::started, EventCode::device_lost, EventCode::device_back}));
  EXPECT_EQ(newest().argument, 1);
}

TEST_F(SupervisorTest, GivenRejectedMatchesInARowThenDegradedAndLost) {
  track();
  supervisor.matched({.accepted = false, .rejection = HealthReason::too_few_points});
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::tracking) << "one is none";
  supervisor.matched({.accepted = false, .rejection = HealthReason::too_few_points});
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::degraded);
  EXPECT_EQ(supervisor.reason(), HealthReason::too_few_points);
  for (int i = 0; i < 13; ++i) {
    supervisor.matched({.accepted = false, .rejection = HealthReason::match_rejected});
  }
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::lost);
}

TEST_F(SupervisorTest, GivenAnAcceptedMatchBetweenThenTheRowBeginsAnew) {
  track();
  for (int i = 0; i < 20; ++i) {
    supervisor.matched({.accepted = i % 2 == 0, .agreement = 1.0F, .inlier_share = 1.0F});
    tick();
    ASSERT_EQ(supervisor.state(), HealthState::tracking);
  }
}

TEST_F(SupervisorTest, GivenAnUnobservableDirectionThenDegradedUntilItIsSeen) {
  track();
  supervisor.matched(
      {.accepted = true, .direction_unobservable = true, .agreement = 1.0F, .inlier_share = 1.0F});
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::direction_unobservable);
  supervisor.matched(kGood);
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::tracking);
}

TEST_F(SupervisorTest, GivenJumpsBeyondChanceThenTheSensorsDisagreeUntilGoodMatchesReturn) {
  track();
  supervisor.matched(kGood, {.jumped = true});
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::tracking) << "one jump is a correction";
  supervisor.matched(kGood, {.jumped = true});
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::sensors_disagree);
  EXPECT_TRUE(supervisor.doubts_pose());
  supervisor.matched(kGood);
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::degraded) << "one match in a row";
  for (int i = 0; i < 3; ++i) { supervisor.matched(kGood); }
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::degraded) << "ten have to prove the pose";
  for (int i = 0; i < 7; ++i) { supervisor.matched(kGood); }
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::tracking);
  EXPECT_FALSE(supervisor.doubts_pose());
}

TEST_F(SupervisorTest, GivenJumpsWithLongPausesThenTheyAreForgiven) {
  track();
  for (int round = 0; round < 10; ++round) {
    supervisor.matched(kGood, {.jumped = true});
    supervisor.matched(kGood);
    supervisor.matched(kGood);
    tick();
    ASSERT_EQ(supervisor.state(), HealthState::tracking);
  }
}

TEST_F(SupervisorTest, GivenAPoorMatchThatJumpsThenTheSensorsDisagreeAtOnce) {
  track();
  supervisor.matched({.accepted = true, .agreement = 1.0F, .inlier_share = 0.4F}, {.jumped = true});
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::sensors_disagree);
}

TEST_F(SupervisorTest, GivenPoorMatchesWithoutJumpsThenTrackingGoesOn) {
  track();
  for (int i = 0; i < 20; ++i) {
    supervisor.matched({.accepted = true, .agreement = 1.0F, .inlier_share = 0.4F});
  }
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::tracking) << "new surroundings fit nothing yet";
}

TEST_F(SupervisorTest, GivenPoorMatchesThatTheMapContradictsThenTheSecondIsTold) {
  const MatchVerdict doubtful{.accepted = true, .agreement = 0.85F, .inlier_share = 0.4F};
  track();
  supervisor.matched(doubtful);
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::tracking) << "somebody passes by";
  supervisor.matched(doubtful);
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::sensors_disagree);
}

TEST_F(SupervisorTest, GivenALostPoseThenPoorMatchesDoNotBringItBack) {
  track();
  for (int i = 0; i < 15; ++i) { supervisor.matched({.accepted = false}); }
  tick();
  ASSERT_EQ(supervisor.state(), HealthState::lost);
  EXPECT_TRUE(supervisor.doubts_pose());
  for (int i = 0; i < 50; ++i) {
    supervisor.matched({.accepted = true, .agreement = 0.9F, .inlier_share = 0.49F});
    supervisor.matched({.accepted = true, .agreement = 0.7F, .inlier_share = 0.7F});
    tick();
    ASSERT_EQ(supervisor.state(), HealthState::lost) << "a place that looks alike";
  }
  for (int i = 0; i < 5; ++i) { supervisor.matched(kGood); }
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::degraded);
}

TEST_F(SupervisorTest, GivenAPullThenTheSensorsDisagreeAsLongAsItLasts) {
  track();
  supervisor.matched(kGood, {.pulled = true});
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::sensors_disagree);
  for (int i = 0; i < 4; ++i) { supervisor.matched(kGood); }
  EXPECT_TRUE(supervisor.unproven()) << "the pose may have been drawn along";
  supervisor.matched(kGood);
  EXPECT_FALSE(supervisor.unproven());
  for (int i = 0; i < 44; ++i) { supervisor.matched(kGood); }
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::degraded) << "nothing has explained it";
  supervisor.matched(kGood);
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::tracking);
}

TEST_F(SupervisorTest, GivenTurnsThatDisagreeThenDegradedAtOnce) {
  track();
  supervisor.turns(true);
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::sensors_disagree);
  supervisor.turns(false);
  for (int i = 0; i < 10; ++i) { supervisor.matched(kGood); }
  for (int i = 0; i < 25; ++i) { tick(); }
  EXPECT_EQ(supervisor.state(), HealthState::tracking);
}

TEST_F(SupervisorTest, GivenASensorInDoubtThenOneEventAndTheMapWaitsForGoodMatches) {
  track();
  supervisor.doubted(now, doubt_of(SensorIndex::right_wheel));
  EXPECT_EQ(newest().code, EventCode::sensor_doubted);
  EXPECT_EQ(newest().argument, 1);
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::sensors_disagree);
  EXPECT_TRUE(supervisor.doubts_pose());
  EXPECT_FALSE(supervisor.unproven()) << "the lidar still sees where it is";
  const std::size_t events = ring.size();
  supervisor.doubted(now, doubt_of(SensorIndex::right_wheel));
  EXPECT_EQ(ring.size(), events) << "told already";
  supervisor.doubted(now, 0);
  for (int i = 0; i < 5; ++i) { supervisor.matched(kGood); }
  EXPECT_FALSE(supervisor.doubts_pose());
}

TEST_F(SupervisorTest, GivenAnAccelerometerInDoubtThenAnEventAndNoMore) {
  track();
  supervisor.doubted(now, doubt_of(SensorIndex::accelerometer));
  tick();
  EXPECT_EQ(newest().code, EventCode::sensor_doubted);
  EXPECT_EQ(supervisor.state(), HealthState::tracking) << "nothing of the pose comes from it";
}

TEST_F(SupervisorTest, GivenAVehicleThatLeansOrTurnsUnseenThenDegradedForThatReason) {
  track();
  supervisor.tilted(true);
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::tilted);
  supervisor.tilted(false);
  supervisor.turn_unverified(true);
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::turn_unverified);
}

TEST_F(SupervisorTest, GivenASecondWithoutAMatchThenWhatComesHasToProveThePose) {
  track();
  estimate.matches = 3;
  estimate.match_age = 1s + 1ms;
  tick();
  EXPECT_TRUE(supervisor.unproven());
  estimate.match_age = 50ms;
  for (int i = 0; i < 5; ++i) { supervisor.matched(kGood); }
  EXPECT_FALSE(supervisor.unproven());
}

TEST_F(SupervisorTest, GivenALongSearchThenDegradedForThatReason) {
  track();
  estimate.match_age = 1s;
  supervisor.searching(true);
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::relocalising);
}

TEST_F(SupervisorTest, GivenSweepsThatAreReplacedOrDroppedThenOneEventOfAKindASecond) {
  const auto count_of = [this](EventCode code) {
    const auto all = codes();
    return std::count(all.begin(), all.end(), code);
  };
  supervisor.sweeps(now, 0, 0);
  EXPECT_EQ(ring.size(), 1U);
  supervisor.sweeps(now, 1, 0);
  EXPECT_EQ(newest().code, EventCode::sweep_replaced);
  EXPECT_EQ(newest().argument, 1);
  supervisor.sweeps(now, 1, 3);
  EXPECT_EQ(newest().code, EventCode::sweep_dropped);
  EXPECT_EQ(newest().argument, 3);
  for (std::uint32_t i = 0; i <= 20; ++i) {
    now += 100ms;
    supervisor.sweeps(now, 2 + i, 3);
  }
  EXPECT_EQ(count_of(EventCode::sweep_replaced), 3) << "at 0, 1 and 2 s";
  EXPECT_EQ(count_of(EventCode::sweep_dropped), 1);
  EXPECT_EQ(newest().argument, 21) << "the count at 2 s";
}

TEST_F(SupervisorTest, GivenAVaguePoseThenLost) {
  track();
  estimate.match_covariance = Matrix3f::diagonal(0.2F, 0.2F, 0.0F);
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::lost)
      << "the limit of 0.25 m^2 holds for both axes together";
}

TEST_F(SupervisorTest, GivenAnOverrunThenItIsToldWithItsTaskAndHeldAgainstThePose) {
  track();
  run_frame(2ms);
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::degraded);
  EXPECT_EQ(supervisor.reason(), HealthReason::overrun);
  const auto all = codes();
  const auto told = std::find(all.begin(), all.end(), EventCode::overrun);
  ASSERT_NE(told, all.end());
  EXPECT_EQ(ring[static_cast<std::size_t>(told - all.begin())].argument, 0) << "the first task";
}

TEST_F(SupervisorTest, GivenSlippedFramesThenTheirNumberIsTold) {
  track();
  now += 50ms;
  run_frame();
  tick();
  EXPECT_EQ(supervisor.reason(), HealthReason::overrun);
  const Event& told = ring[ring.size() - 2];
  EXPECT_EQ(told.code, EventCode::frames_slipped);
  EXPECT_EQ(told.argument, 14)
      << "75 ms after the start frame 15 is due, 14 comes first to be caught up";
}

TEST_F(SupervisorTest, GivenATaskThatMayNotOverrunThenFault) {
  track();
  run_frame(10us, 2ms);
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::fault);
  EXPECT_EQ(supervisor.reason(), HealthReason::overrun);
}

TEST_F(SupervisorTest, GivenARefusedConfigurationThenFault) {
  supervisor.refuse_configuration();
  tick();
  EXPECT_EQ(supervisor.state(), HealthState::fault);
  EXPECT_EQ(supervisor.reason(), HealthReason::configuration);
}

}  // namespace
}  // namespace picolo
