// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A map saved by a vehicle on its way, and the next day's drive localised in it.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "drive.hpp"
#include "picolo/sim/sim_byte_store.hpp"

namespace picolo {
namespace {

using test::Drive;

struct Flash {
  std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(2 * 80 * 1024);
  sim::SimByteStore device{memory, 4096, 8};
};

using Robot = SimulatedController<RoomProfile>;

std::vector<std::int8_t> cells_of(const Robot& robot) {
  const auto occupancy = robot.controller().pipeline().localiser().map().occupancy();
  return {occupancy.begin(), occupancy.end()};
}

TEST(StoredMap, SavedWhileDrivingThenLocalisedInAndLeftAsItIs) {
  Flash flash;
  {
    Drive drive{test::drive_in(sim::SceneName::room)};
    drive.until(12s);
    MapStore store{flash.device};
    ASSERT_EQ(store.begin_save(drive.controller().pipeline().localiser().map()), Status::ok);
    Status status = Status::not_ready;
    while (status == Status::not_ready) {
      ASSERT_EQ(drive.robot().run_frame(), Status::ok);
      status = store.step(4);
    }
    EXPECT_EQ(status, Status::ok) << "while the map goes on changing";
    EXPECT_EQ(drive.state(), HealthState::tracking);
  }
  sim::SimulationConfig next_day = test::drive_in(sim::SceneName::room);
  next_day.seed = 12;
  Robot robot{next_day};
  MapStore store{flash.device};
  ASSERT_EQ(robot.controller().load_map(store), Status::ok);
  const std::vector<std::int8_t> loaded = cells_of(robot);
  EXPECT_GT(std::ranges::count_if(loaded, [](std::int8_t c) { return c >= 15; }), 100);
  ASSERT_EQ(robot.start(), Status::ok);
  double worst_m = 0.0;
  int tracking = 0;
  int frames = 0;
  while (robot.controller().next_frame() < next_day.start + 20s) {
    ASSERT_EQ(robot.run_frame(), Status::ok);
    const PoseEstimate& pose = robot.controller().estimate();
    const Result<Pose2d> truth = robot.true_map_T_base(pose.stamp);
    ++frames;
    if (!truth || pose.state != HealthState::tracking) { continue; }
    ++tracking;
    worst_m = std::max(
        worst_m, std::hypot(pose.map_T_base.x_m - truth->x_m, pose.map_T_base.y_m - truth->y_m));
  }
  EXPECT_GT(tracking, frames * 9 / 10);
  EXPECT_LT(worst_m, 0.10);
  EXPECT_TRUE(cells_of(robot) == loaded);
}

TEST(StoredMap, AnEmptyStoreLeavesAControllerThatBuildsItsMap) {
  Flash flash;
  Robot robot{test::drive_in(sim::SceneName::room)};
  MapStore store{flash.device};
  EXPECT_EQ(robot.controller().load_map(store), Status::not_ready);
  ASSERT_EQ(robot.start(), Status::ok);
  for (int k = 0; k < 600; ++k) { ASSERT_EQ(robot.run_frame(), Status::ok); }
  EXPECT_EQ(robot.controller().estimate().state, HealthState::tracking);
  EXPECT_GT(robot.controller().pipeline().localiser().counters().inserted, 0U);
}

/// When a vehicle that was told a wrong start in a map of the office, window of 102 m, tracks.
Duration found_after(sim::SimByteStore& flash, std::uint32_t slices) {
  using LargeRobot = SimulatedController<SiteProfile>;
  ControllerConfig config = simulated_vehicle_config();
  config.start_map_T_base = {3.0, 2.0, 1.5};
  config.work.max_search_slices = slices;
  const sim::SimulationConfig simulation = test::drive_in(sim::SceneName::office);
  const auto robot = std::make_unique<LargeRobot>(simulation, config);
  MapStore store{flash};
  EXPECT_EQ(robot->controller().load_map(store), Status::ok);
  EXPECT_EQ(robot->start(), Status::ok);
  const PoseEstimate& pose = robot->controller().estimate();
  while (pose.state != HealthState::tracking) {
    EXPECT_EQ(robot->run_frame(), Status::ok);
    if (robot->controller().next_frame() > simulation.start + 60s) { return 60s; }
  }
  const Pose2d truth = robot->true_map_T_base(pose.stamp).value_or(Pose2d{});
  EXPECT_LT(std::hypot(pose.map_T_base.x_m - truth.x_m, pose.map_T_base.y_m - truth.y_m), 0.05);
  return robot->controller().last_frame().start - simulation.start;
}

TEST(StoredMap, GivenAWrongStartInALargeMapThenMoreSlicesOfSearchFindItSooner) {
  std::vector<std::uint8_t> memory(4 << 20);
  sim::SimByteStore flash{memory, 4096, 8};
  {
    const sim::SimulationConfig simulation = test::drive_in(sim::SceneName::office);
    const auto robot = std::make_unique<SimulatedController<SiteProfile>>(simulation);
    ASSERT_EQ(robot->start(), Status::ok);
    while (robot->controller().next_frame() < simulation.start + 60s) {
      ASSERT_EQ(robot->run_frame(), Status::ok);
    }
    MapStore store{flash};
    ASSERT_EQ(store.begin_save(robot->controller().pipeline().localiser().map()), Status::ok);
    Status status = Status::not_ready;
    while (status == Status::not_ready) { status = store.step(4096); }
    ASSERT_EQ(status, Status::ok);
  }
  const Duration few = found_after(flash, ControllerConfig{}.work.max_search_slices);
  const Duration many = found_after(flash, 32);  // as `picolo run`
  std::printf("tracking after %.1f s with 4 slices in a cycle, %.1f s with 32\n",
              to_seconds_f64(few), to_seconds_f64(many));
  EXPECT_LT(few, 15s);
  EXPECT_LT(3 * many, few);
}

}  // namespace
}  // namespace picolo
