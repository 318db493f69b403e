// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Devices that fall silent, lie, or are unplugged: the pose says so, and comes back by itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive.hpp"

namespace picolo {
namespace {

using sim::Device;
using sim::FaultKind;
using sim::SceneName;
using test::Drive;
using test::Publication;
using ::testing::ElementsAre;

constexpr auto kInit = HealthState::initialising;
constexpr auto kTracking = HealthState::tracking;
constexpr auto kDegraded = HealthState::degraded;
constexpr auto kLost = HealthState::lost;

sim::Fault from_10_to_13_s(Device device, FaultKind kind) {
  return {.device = device, .kind = kind, .begin = 10s, .end = 13s};
}

TEST(Faults, GivenASilentLidarThenDegradedOnOdometryUntilItSpeaks) {
  Drive drive{
      test::drive_in(SceneName::office, {from_10_to_13_s(Device::lidar, FaultKind::silence)})};
  drive.until(10s);
  const float sigma_before = drive.controller().estimate().match_covariance(0, 0);
  drive.until(10s + 500ms);
  EXPECT_EQ(drive.state(), kDegraded);
  EXPECT_EQ(drive.reason(), HealthReason::lidar_silent);
  double worst_m = 0.0;
  drive.until(13s, [&](const Publication& publication) {
    EXPECT_EQ(publication.estimate.state, kDegraded);
    worst_m = std::max(worst_m, publication.position_error_m);
  });
  EXPECT_LT(worst_m, 0.2) << "odometry carries on";
  EXPECT_GT(drive.controller().estimate().match_age, 2900ms);
  EXPECT_GT(drive.controller().estimate().match_covariance(0, 0), 4.0F * sigma_before);
  drive.until(15s);
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_LT(drive.judged().position_error_m, 0.1);
  EXPECT_THAT(drive.states(), ElementsAre(kTracking, kDegraded, kTracking));
  EXPECT_EQ(drive.silent_wrong(), 0);
}

TEST(Faults, GivenAnUnpluggedLidarThenTheEventsTellWhenItWentAndCame) {
  Drive drive{
      test::drive_in(SceneName::room, {from_10_to_13_s(Device::lidar, FaultKind::disconnect)})};
  drive.until(12s);
  EXPECT_FALSE(drive.controller().supervisor().connected(DeviceIndex::lidar));
  drive.until(16s);
  EXPECT_EQ(drive.state(), kTracking);
  const auto lost = drive.events(EventCode::device_lost);
  const auto back = drive.events(EventCode::device_back);
  ASSERT_EQ(lost.size(), 1U);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(lost[0].argument, static_cast<std::int32_t>(DeviceIndex::lidar));
  EXPECT_NEAR(static_cast<double>(lost[0].stamp_us), 10e6, 10e3);
  EXPECT_NEAR(static_cast<double>(back[0].stamp_us), 13e6, 10e3);
}

TEST(Faults, GivenASilentGyroThenTheWheelsTurnAloneAndTheStateSaysSo) {
  Drive drive{
      test::drive_in(SceneName::office, {from_10_to_13_s(Device::imu, FaultKind::silence)})};
  drive.until(12s);
  EXPECT_EQ(drive.state(), kDegraded);
  EXPECT_EQ(drive.reason(), HealthReason::gyro_silent);
  drive.until(15s);
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_LT(drive.judged().position_error_m, 0.1);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

/// Without wheels: degraded for the whole time, the pose fresh and true, tracking afterwards.
void expect_lidar_alone(Drive& drive) {
  drive.until(10s + 300ms);
  EXPECT_EQ(drive.state(), kDegraded);
  EXPECT_EQ(drive.reason(), HealthReason::wheels_silent);
  double worst_m = 0.0;
  Duration oldest{0};
  drive.until(13s, [&](const Publication& publication) {
    EXPECT_EQ(publication.estimate.state, kDegraded);
    worst_m = std::max(worst_m, publication.position_error_m);
    oldest = std::max(oldest, publication.estimate.match_age);
  });
  EXPECT_LT(worst_m, 0.12) << "the lidar is well";
  EXPECT_LT(oldest, 250ms);
  EXPECT_LT(drive.controller().next_frame() - drive.controller().estimate().stamp, 25ms);
  EXPECT_GT(drive.controller().pipeline().counters().coasted, 250U);
  drive.until(16s);
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_LT(drive.judged().position_error_m, 0.12);
  EXPECT_THAT(drive.states(), ElementsAre(kTracking, kDegraded, kTracking));
  EXPECT_EQ(drive.silent_wrong(), 0);
}

TEST(Faults, GivenOneSilentWheelThenTheLidarGoesOnAlone) {
  Drive drive{
      test::drive_in(SceneName::room, {from_10_to_13_s(Device::wheel_left, FaultKind::silence)})};
  expect_lidar_alone(drive);
}

TEST(Faults, GivenSilentWheelsAndGyroThenTheLastMatchesTellTheTurn) {
  Drive drive{
      test::drive_in(SceneName::office, {from_10_to_13_s(Device::wheel_left, FaultKind::silence),
                                         from_10_to_13_s(Device::imu, FaultKind::silence)})};
  expect_lidar_alone(drive);
}

TEST(Faults, GivenNeitherWheelsNorLidarThenLostAndFoundAgain) {
  Drive drive{
      test::drive_in(SceneName::room, {from_10_to_13_s(Device::wheel_left, FaultKind::silence),
                                       from_10_to_13_s(Device::lidar, FaultKind::silence)})};
  drive.until(10s + 300ms);
  EXPECT_EQ(drive.state(), kDegraded);
  const Timestamp frozen_at = drive.controller().estimate().stamp;
  drive.until(12s);
  EXPECT_EQ(drive.state(), kLost) << "nothing tells the motion";
  EXPECT_LE(drive.controller().estimate().stamp - frozen_at, 300ms)
      << "the pose does not pretend to be newer";
  drive.until(25s);
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_LT(drive.judged().position_error_m, 0.12);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

TEST(Faults, GivenAWheelThatLosesPowerThenItIsStartedAgainAndItsJumpIsNoMotion) {
  sim::Fault power_loss{.device = Device::wheel_right,
                        .kind = FaultKind::disconnect,
                        .begin = 10s,
                        .end = 10s + 200ms};
  Drive drive{test::drive_in(SceneName::room, {power_loss})};
  drive.until(10s + 200ms);
  const Pose2d before = drive.controller().estimate().odom_T_base;
  drive.until(11s);
  const Pose2d after = drive.controller().estimate().odom_T_base;
  EXPECT_LT(std::hypot(after.x_m - before.x_m, after.y_m - before.y_m), 0.6)
      << "counts start at 0 again: no leap";
  drive.until(18s);  // a displacement that nothing explains is forgiven after 5 s of good matches
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_LT(drive.judged().position_error_m, 0.12);
}

TEST(Faults, GivenTheWholeBusGoneThenTheLidarGoesOnAlone) {
  Drive drive{
      test::drive_in(SceneName::room, {from_10_to_13_s(Device::can_bus, FaultKind::disconnect)})};
  drive.until(12s);
  EXPECT_EQ(drive.state(), kDegraded);
  EXPECT_FALSE(drive.controller().supervisor().connected(DeviceIndex::wheels));
  EXPECT_GT(drive.controller().reporter().refused(), 0U);
  EXPECT_LT(drive.judged().position_error_m, 0.12);
  drive.until(18s);
  EXPECT_TRUE(drive.controller().supervisor().connected(DeviceIndex::wheels));
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_LT(drive.judged().position_error_m, 0.12);
}

TEST(Faults, GivenEverythingSilentFromTheStartThenInitialisingForever) {
  Drive drive{test::drive_in(SceneName::room,
                             {{.device = Device::lidar, .kind = FaultKind::silence, .end = 1h}})};
  drive.until(5s,
              [](const Publication& publication) { EXPECT_EQ(publication.estimate.state, kInit); });
  EXPECT_EQ(drive.reason(), HealthReason::lidar_silent);
}

TEST(Faults, GivenDamagedBytesThenTheyAreCountedAndThePoseStaysTrue) {
  Drive drive{test::drive_in(SceneName::office, {{.device = Device::lidar,
                                                  .kind = FaultKind::corrupt,
                                                  .begin = 5s,
                                                  .end = 25s,
                                                  .probability = 0.1F},
                                                 {.device = Device::imu,
                                                  .kind = FaultKind::corrupt,
                                                  .begin = 5s,
                                                  .end = 25s,
                                                  .probability = 0.1F}})};
  drive.until(2s);
  double worst_m = 0.0;
  drive.until(30s, [&](const Publication& publication) {
    worst_m = std::max(worst_m, publication.position_error_m);
  });
  EXPECT_GT(drive.robot().lidar().counters().bad_checksums, 100U);
  EXPECT_GT(drive.robot().imu().counters().bad_checksums, 50U);
  EXPECT_LT(worst_m, 0.12);
  EXPECT_EQ(drive.state(), kTracking);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

TEST(Faults, GivenLateLidarPacketsThenTheirStampsStillFitTheOdometry) {
  Drive drive{test::drive_in(SceneName::office, {{.device = Device::lidar,
                                                  .kind = FaultKind::delay,
                                                  .begin = 5s,
                                                  .end = 25s,
                                                  .probability = 0.02F,
                                                  .delay = 20ms}})};
  drive.until(2s);
  double worst_m = 0.0;
  drive.until(30s, [&](const Publication& publication) {
    worst_m = std::max(worst_m, publication.position_error_m);
  });
  EXPECT_LT(worst_m, 0.12);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

/// Drives that once ended in a pose that was wrong without a word; the whole matrix is in
/// tests/integration/fault_matrix.
struct KnownTrap {
  SceneName scene;
  Device device;
  FaultKind kind;
  std::uint64_t seed;
};

TEST(Faults, GivenTheTrapsOfThePastThenNoSilentWrongPose) {
  for (const KnownTrap& trap :
       {KnownTrap{SceneName::office, Device::wheel_left, FaultKind::disconnect, 4},
        KnownTrap{SceneName::room, Device::wheel_right, FaultKind::disconnect, 6},
        KnownTrap{SceneName::office, Device::lidar, FaultKind::duplicate, 1},
        KnownTrap{SceneName::office, Device::lidar, FaultKind::freeze, 16},
        KnownTrap{SceneName::office, Device::lidar, FaultKind::freeze, 19}}) {
    const Duration begin = 10s + static_cast<std::int64_t>(trap.seed) * 1370ms;
    sim::SimulationConfig simulation = test::drive_in(trap.scene, {{.device = trap.device,
                                                                    .kind = trap.kind,
                                                                    .begin = begin,
                                                                    .end = begin + 3s,
                                                                    .probability = 0.3F,
                                                                    .delay = 30ms}});
    simulation.seed = trap.seed;
    Drive drive{simulation};
    drive.until(begin + 12s);
    EXPECT_EQ(drive.silent_wrong(), 0) << "seed " << trap.seed;
  }
}

TEST(Faults, GivenAFeaturelessCorridorThenTheStateSaysSoAndThePoseHolds) {
  Drive drive{test::drive_in(SceneName::corridor)};
  double worst_m = 0.0;
  bool told = false;
  drive.until(60s, [&](const Publication& publication) {
    worst_m = std::max(worst_m, publication.position_error_m);
    told |= publication.estimate.reason == HealthReason::direction_unobservable;
  });
  EXPECT_TRUE(told);
  EXPECT_LT(worst_m, 0.15);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

TEST(Faults, GivenSurroundingsThatTheWindowForgotThenNoWideSearchHoldsUpTheMatch) {
  Drive drive{test::drive_in(SceneName::hall)};
  Duration oldest{0};
  drive.until(5s);
  drive.until(120s, [&](const Publication& publication) {
    oldest = std::max(oldest, publication.estimate.match_age);
  });
  EXPECT_LT(oldest, 150ms);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

}  // namespace
}  // namespace picolo
