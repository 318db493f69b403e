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

}  // namespace
}  // namespace picolo
