// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The wiring, with devices that a test plays: who is drained when, bounded by what, and what a slow
// or missing one does.

#include "picolo/controller/controller.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "rig.hpp"

namespace picolo {
namespace {

using test::FakeImu;
using test::FakeLidar;
using test::FakeWheels;
using test::Rig;
using test::SmallProfile;

TEST(ControllerWiring, BeforeItsTimeNothingRuns) {
  Rig<FakeImu> rig;
  rig.run_frame();
  EXPECT_EQ(rig.controller.run_frame(), Status::not_ready);
  EXPECT_EQ(rig.controller.next_frame(), Timestamp{1s + 5ms});
}

TEST(ControllerWiring, GivenMoreFramesThanTheBoundThenTheRestWaitsForTheNextCycle) {
  ControllerConfig config;
  config.work.max_can_frames = 5;
  Rig<FakeImu> rig{config};
  for (int i = 0; i < 12; ++i) { rig.can.arrives(test::can_frame(Timestamp{1s}, 0x555)); }
  rig.run_frame();
  EXPECT_EQ(rig.can.waiting(), 7U);
  rig.run_frame();
  rig.run_frame();
  EXPECT_EQ(rig.can.waiting(), 0U);
  EXPECT_EQ(rig.controller.counters().can_frames, 12U);
  EXPECT_EQ(rig.controller.counters().foreign_frames, 12U);
}

TEST(ControllerWiring, GivenSeveralSamplesInOneFrameThenAllReachTheOdometry) {
  Rig<FakeImu> rig;
  for (std::uint8_t i = 0; i < 4; ++i) {
    rig.can.arrives(test::can_frame(Timestamp{1s + i * 1ms}, 0x181, {i}));
  }
  rig.run_frame();
  EXPECT_EQ(rig.controller.counters().ticks, 4U);
  EXPECT_EQ(rig.controller.pipeline().counters().increments, 3U);
  EXPECT_EQ(rig.controller.counters().ticks_lost, 0U);
}

TEST(ControllerWiring, GivenMoreSamplesThanCanBeKeptThenTheLossIsCounted) {
  Rig<FakeImu> rig;
  for (std::uint8_t i = 0; i < 11; ++i) {
    rig.can.arrives(test::can_frame(Timestamp{1s + i * 100us}, 0x181, {i}));
  }
  rig.run_frame();
  EXPECT_EQ(rig.controller.counters().ticks_lost, 3U);
}

TEST(ControllerWiring, TheWheelsAreServicedEveryFrameWithItsTime) {
  Rig<FakeImu> rig;
  for (int i = 0; i < 3; ++i) { rig.run_frame(); }
  EXPECT_EQ(rig.wheels.serviced,
            (std::vector{Timestamp{1s}, Timestamp{1s + 5ms}, Timestamp{1s + 10ms}}));
}

TEST(ControllerWiring, SerialLinesAreReadInSlicesUntilTheyAreSilent) {
  ControllerConfig config;
  config.work.max_serial_bytes = 400;
  Rig<FakeImu> rig{config};
  for (int i = 0; i < 60; ++i) { rig.lidar.waiting.push_back(test::beam(Timestamp{1s}, i, {})); }
  rig.run_frame();
  EXPECT_EQ(rig.lidar.asked_bytes, (std::vector<std::size_t>{100, 100, 100}))
      << "48, 12, and nothing";
  EXPECT_EQ(rig.imu.asked_bytes, (std::vector<std::size_t>{100}));
  EXPECT_EQ(rig.controller.counters().readings, 60U);
}

TEST(ControllerWiring, GivenALineThatNeverFallsSilentThenTheBoundHolds) {
  Rig<FakeImu> rig;
  for (int i = 0; i < 5000; ++i) { rig.imu.waiting.push_back({.stamp = Timestamp{1s + i * 1us}}); }
  rig.run_frame();
  EXPECT_EQ(rig.imu.asked_bytes.size(), 4U);
  EXPECT_EQ(rig.controller.counters().imu_samples, 32U);
}

TEST(ControllerWiring, GivenADeviceThatIsGoneThenEventsTellIt) {
  Rig<FakeImu> rig;
  rig.imu.when_empty = Status::disconnected;
  rig.run_frame();
  EXPECT_FALSE(rig.controller.supervisor().connected(DeviceIndex::imu));
  rig.can.disconnect();
  rig.run_frame();
  EXPECT_FALSE(rig.controller.supervisor().connected(DeviceIndex::wheels));
  rig.can.reconnect();
  rig.run_frame();
  EXPECT_TRUE(rig.controller.supervisor().connected(DeviceIndex::wheels));
  EXPECT_EQ(rig.events.size(), 4U) << "started, lost, lost, back";
}

TEST(ControllerWiring, ReportsGoOutInEveryFifthFrameAndAFullBusIsNoProblem) {
  Rig<FakeImu> rig;
  for (int i = 0; i < 20; ++i) { rig.run_frame(); }
  // four reports of pose, health, twist and time; the event "started" with its time; both sigmas,
  // correlations and a counter in turns, no calibration
  constexpr std::uint32_t kFirst = 4 * 4 + 2 + 2 + 1 + 1;
  EXPECT_EQ(rig.can.take_sent().size(), kFirst);
  rig.can.send_queue_is_full(true);
  for (int i = 0; i < 20; ++i) { rig.run_frame(); }
  EXPECT_EQ(rig.controller.reporter().sent(), kFirst);
  EXPECT_GE(rig.controller.reporter().refused(), kFirst - 2) << "the event was told before";
}

TEST(ControllerWiring, GivenFramesOutSwitchedOffThenTheBusIsLeftAlone) {
  ControllerConfig config;
  config.frames_out.enabled = false;
  Rig<FakeImu> rig{config};
  for (int i = 0; i < 40; ++i) { rig.run_frame(); }
  EXPECT_TRUE(rig.can.sent().empty());
  EXPECT_EQ(rig.controller.reporter().refused(), 0U);
}

TEST(ControllerWiring, GivenADeviceThatTakesTooLongThenTheOverrunIsToldAndTheCycleGoesOn) {
  Rig<FakeImu> rig;
  for (int i = 0; i < 20; ++i) { rig.run_frame(); }
  EXPECT_EQ(rig.watchdog.strokes, 1);
  rig.lidar.slow = 17ms;
  rig.run_frame();
  rig.lidar.slow = 0ms;
  for (int i = 0; i < 9; ++i) { rig.run_frame(); }
  EXPECT_EQ(
      rig.controller.schedule().counters(static_cast<std::size_t>(ControllerTask::serial)).overruns,
      1U);
  EXPECT_EQ(rig.controller.schedule().frame_counters().slipped, 1U)
      << "late by two frames: one is caught up";
  bool told = false;
  for (std::size_t i = 0; i < rig.events.size(); ++i) {
    told = told || (rig.events[i].code == EventCode::overrun &&
                    rig.events[i].argument == static_cast<std::int32_t>(ControllerTask::serial));
  }
  EXPECT_TRUE(told);
}

TEST(ControllerWiring, GivenNoImuThenItsSilenceIsNoFault) {
  ControllerConfig config;
  config.health.expects_gyro = false;
  Rig<NoImu> rig{config};
  for (int i = 0; i < 200; ++i) { rig.run_frame(); }
  EXPECT_EQ(rig.controller.supervisor().state(), HealthState::initialising);
  EXPECT_EQ(rig.controller.supervisor().reason(), HealthReason::lidar_silent)
      << "the lidar is what is missing";
}

TEST(ControllerWiring, GivenEventsThatCameThroughAResetThenTheyAreKept) {
  Rig<FakeImu> first;
  for (int i = 0; i < 100; ++i) { first.run_frame(); }
  const std::size_t before = first.events.size();
  ASSERT_GT(before, 1U);

  FakeImu imu;
  FakeLidar lidar;
  Controller<SmallProfile, FakeWheels, FakeLidar, FakeImu>* after_reset =
      new Controller<SmallProfile, FakeWheels, FakeLidar, FakeImu>(
          Board{first.can, first.clock, first.cycles, first.watchdog}, first.wheels, lidar, imu,
          first.events, ControllerConfig{});
  const std::unique_ptr<Controller<SmallProfile, FakeWheels, FakeLidar, FakeImu>> owner{
      after_reset};
  ASSERT_EQ(after_reset->start(), Status::ok);
  ASSERT_EQ(first.events.size(), before + 1);
  EXPECT_EQ(first.events[before].code, EventCode::started);
  EXPECT_EQ(first.events[before].argument, 1);
}

TEST(ControllerConfigTest, GivenPartsThatAreRefusedThenTheWholeIsRefused) {
  const auto refused = [](void (*change)(ControllerConfig&)) {
    ControllerConfig config;
    change(config);
    return !config.valid();
  };
  EXPECT_FALSE(refused([](ControllerConfig&) {}));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.cycle.minor_frame = 3ms; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.work.max_can_frames = 0; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.work.max_rays = 0; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.work.max_search_slices = 0; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.plausibility.max_wheel_speed_mps = 0.0F; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.trust.pull_kept = 1.0F; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.max_bridge = -1us; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.budgets.match = 4ms; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.drive.track_m = 0.0; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.dead_reckoning.gyro_sign = 0.5F; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.sweeps.min_readings = 0; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.undistort.frame = SweepFrame::lidar; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.undistort.reference = SweepReference::stamp; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.localiser.max_repair_tiles = 0; }));
  EXPECT_TRUE(
      refused([](ControllerConfig& c) { c.localiser.uncertainty.odometry.walk_m = -1.0F; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.health.initial_matches = 0; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.frames_out.base_id = 0x111; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.max_prediction = -1us; }));
  EXPECT_TRUE(refused([](ControllerConfig& c) { c.trust.max_doubt = -1; }));
}

TEST(ControllerTasks, TheTableIsInTheOrderOfTheEnumeration) {
  const auto table = controller_tasks(WorkBounds{}, TaskBudgets{});
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::can)].name, "can");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::serial)].name, "serial");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::odometry)].name, "odometry");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::undistort)].name, "undistort");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::match)].name, "match");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::map)].name, "map");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::background)].name, "background");
  EXPECT_STREQ(table[static_cast<std::size_t>(ControllerTask::report)].name, "report");
}

}  // namespace
}  // namespace picolo
