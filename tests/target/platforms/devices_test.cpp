// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Ports on the memory-mapped devices of their boards: the conformance suite, and the controller
// that lives by their interrupts.

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "picolo/localisation/pose_estimate.hpp"
#include "platforms.hpp"
#include "support/files.hpp"

namespace picolo::target {
namespace {

/// Two serial lines of a board, connected with each other through a socket of QEMU's.
std::string crossed_lines(const test::TemporaryFolder& folder) {
  const std::string path = ",path=" + (folder.path() / "line").string();
  return "-chardev socket,id=near" + path + ",server=on,wait=off -chardev socket,id=far" + path +
         " -serial chardev:near -serial chardev:far";
}

TEST(Devices, OfEveryBoardKeepTheContractsOfHal) {
  PICOLO_NEED_IMAGES();
  for (const Platform& platform : platforms_to_judge()) {
    if (!std::filesystem::exists(image(platform, "conformance"))) { continue; }
    const test::TemporaryFolder folder;
    const Outcome outcome = run(platform, "conformance", {}, crossed_lines(folder));
    EXPECT_EQ(outcome.status, 0) << platform.name << ":\n" << outcome.output;
    EXPECT_NE(outcome.output.find("CanBus: "), std::string::npos) << outcome.output;
    std::cout << platform.name << "\n" << outcome.output;
  }
}

void print(const Platform& platform, const Figures& found) {
  std::cout << "| " << platform.name << " |";
  for (const auto& [name, value] : found) { std::cout << " " << name << " " << value << " |"; }
  std::cout << "\n";
}

void judge_bus(const Figures& found) {
  // Two nodes boot, are taught their TPDO in 7 exchanges each, are started, and answer each SYNC.
  EXPECT_EQ(found.at("boot_ups"), 2);
  EXPECT_GE(found.at("heartbeats"), 150);
  EXPECT_EQ(found.at("service_answers"), 14);
  EXPECT_EQ(found.at("service_aborts"), 0);
  EXPECT_EQ(found.at("setup_failures"), 0);
  EXPECT_GE(found.at("starts"), 2);
  EXPECT_EQ(found.at("nodes_operational"), 2);
  EXPECT_GE(found.at("syncs"), 780);
  EXPECT_EQ(found.at("syncs"), found.at("controller_syncs"));
  EXPECT_GE(found.at("process_data"), 2 * (found.at("syncs") - 10));
  EXPECT_EQ(found.at("controller_process_data"), found.at("process_data"));
  // The filters keep the third node out, and nothing else.
  EXPECT_GE(found.at("foreign"), 1000);
  EXPECT_EQ(found.at("can_received"), found.at("boot_ups") + found.at("heartbeats") +
                                          found.at("service_answers") + found.at("process_data"));
}

void judge_pose(const Figures& found) {
  EXPECT_EQ(found.at("state"), static_cast<int>(HealthState::tracking));
  EXPECT_GE(found.at("matches"), 75);
  EXPECT_GE(found.at("travelled_x_um"), 500'000);
  EXPECT_LE(found.at("error_x_um"), 50'000);
  EXPECT_LE(found.at("error_y_um"), 50'000);
  EXPECT_LE(found.at("error_yaw_urad"), 10'000);
  // Other nodes read it off the bus, to half of a bit.
  EXPECT_GE(found.at("poses_read"), 300);
  EXPECT_LE(found.at("bus_deviation_um"), 1001);
}

/// Time is that of the instructions, 1 ns each (-icount): how fast this machine is does not matter.
TEST(Devices, CarryAWholeControllerWithItsCanopenNodes) {
  PICOLO_NEED_IMAGES();
  for (const Platform& platform : platforms_to_judge()) {
    if (!std::filesystem::exists(image(platform, "canopen_vehicle"))) { continue; }
    const Outcome outcome =
        run(platform, "canopen_vehicle", {}, "-icount shift=0,sleep=off -serial null -serial null");
    ASSERT_EQ(outcome.status, 0) << platform.name << ":\n" << outcome.output;
    const Figures found = figures_in(outcome.output);
    print(platform, found);
    judge_bus(found);
    judge_pose(found);
    EXPECT_GE(found.at("frames"), 1590);
    EXPECT_GE(found.at("readings"), 35'000);
    EXPECT_GE(found.at("imu_samples"), 750);
    EXPECT_GE(found.at("timer_wake_ups"), found.at("frames"));
    for (const char* none : {"vehicle_refused", "can_lost", "serial_lost", "unexpected_interrupts",
                             "overruns", "watchdog_fired"}) {
      EXPECT_EQ(found.at(none), 0) << none;
    }
  }
}

}  // namespace
}  // namespace picolo::target
