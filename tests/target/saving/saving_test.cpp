// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Boards that write their flash while they drive: what it costs the cycle, and what the host reads
// out of it after a reset.

#include <gtest/gtest.h>

#include <iostream>

#include "free_drive.hpp"
#include "picolo/controller/calibration_store.hpp"
#include "picolo/controller/onboard_calibration.hpp"
#include "picolo/executive/task.hpp"
#include "support/files.hpp"
#include "support/wired_drive.hpp"

namespace picolo::target {
namespace {

/// A drive with a file for its flash; fails the test when the board did not reach its end.
FreeDrive drive_on(const Platform& platform, FreeDrivePlan& plan,
                   const test::TemporaryFolder& folder) {
  plan.flash_file = folder.file(platform.preset);
  FreeDrive drive = drive_freely(platform, plan);
  EXPECT_EQ(drive.trouble, "");
  auto& figures = drive.figures;
  std::cout << "| " << platform.name << " | " << figures["erases"] << " x " << plan.erase_time / 1ms
            << " ms" << (plan.erase_waits ? ", waits" : "") << " | " << figures["frames"] << " | "
            << figures["slipped"] << " | " << overruns_in(figures) << " | "
            << figures["background_worst_us"] << " us | " << figures["worst_lateness_us"]
            << " us | " << figures["strokes"] << " of " << figures["major_frames"] << " |\n";
  return drive;
}

void tell_heading() {
  std::cout << "| board | erases | cycles | slipped | overruns | worst of background | worst "
               "lateness | major frames stroked |\n|---|---|---|---|---|---|---|---|\n";
}

// The vehicle calibrates itself and saves its map, to the stored record and image.
TEST(Saving, ACalibrationEndsAndAMapIsSavedWithoutASlippedCycle) {
  PICOLO_NEED_IMAGES();
  const test::TemporaryFolder folder;
  FreeDrivePlan plan{
      .world = test::calibration_drive(),
      .seconds = 170,
      .asks = {{1s, {.kind = CommandKind::start_calibration}},
               {100s, {.kind = CommandKind::save_map}},
               {150s, {.kind = CommandKind::start_calibration, .detail = kFinishCalibration}}},
      .erase_time = 45ms};
  tell_heading();
  for (const Platform& platform : boards_with_devices()) {
    SCOPED_TRACE(platform.name);
    FreeDrive drive = drive_on(platform, plan, folder);
    auto& figures = drive.figures;
    EXPECT_EQ(figures["slipped"], 0);
    EXPECT_EQ(figures["late_ends"], 0);
    // The calibration's longest slices are beyond their tasks' budgets, and within the frame.
    EXPECT_EQ(overruns_in(figures), figures["overruns_background"] + figures["overruns_serial"]);
    EXPECT_LT(overruns_in(figures), figures["frames"] / 50);
    EXPECT_EQ(figures["strokes"], figures["major_frames"]);
    EXPECT_EQ(bytes_lost(figures), 0);
    EXPECT_EQ(drive.calibration_phase, CalibrationPhase::done);
    expect_map_kept(plan, drive);
    // The board after its reset, and the host, find what the vehicle is.
    EXPECT_EQ(figures["record_status"], static_cast<int>(Status::ok));
    FileByteStore flash{flash_in(plan.flash_file)};
    ASSERT_EQ(flash.open(plan.flash_file.c_str()), Status::ok);
    CalibrationStore records{flash};
    CalibrationRecord record;
    ASSERT_EQ(records.load(record), Status::ok);
    EXPECT_NEAR(record.drive.radius_left_m, plan.world.vehicle.radius_left_m, 2e-3 * 0.1);
    EXPECT_NEAR(record.drive.radius_right_m, plan.world.vehicle.radius_right_m, 2e-3 * 0.1);
    EXPECT_NEAR(record.drive.track_m, plan.world.vehicle.track_m, 2e-3 * 0.5);
  }
}

// Flash that the program itself runs from stops the processor while a sector is erased.
TEST(Saving, FlashThatStopsTheProcessorSlipsCyclesThatAreAccountedFor) {
  PICOLO_NEED_IMAGES();
  const test::TemporaryFolder folder;
  FreeDrivePlan plan{
      .asks = {{2s, {.kind = CommandKind::save_map}}}, .erase_time = 22ms, .erase_waits = true};
  tell_heading();
  for (const Platform& platform : boards_with_devices()) {
    SCOPED_TRACE(platform.name);
    FreeDrive drive = drive_on(platform, plan, folder);
    auto& figures = drive.figures;
    ASSERT_GT(figures["erases"], 0);
    // An erase is one overrun of the background task. The next frame starts 17 to 18 ms late: 3
    // frames, of which 2 slip.
    EXPECT_EQ(figures["overruns_background"], figures["erases"]);
    EXPECT_LE(overruns_in(figures), 2 * figures["erases"]) << "and one of what has piled up";
    EXPECT_EQ(figures["slipped"], 2 * figures["erases"]);
    EXPECT_GE(figures["frames"] + figures["slipped"], plan.seconds * 200);
    EXPECT_LT(figures["strokes"], figures["major_frames"]);
    EXPECT_EQ(bytes_lost(figures), 0);
    EXPECT_LT(drive.worst_error_m, 0.05);
    EXPECT_EQ(drive.answers, (std::vector{CommandResult::started, CommandResult::done}));
    expect_map_kept(plan, drive);
  }
}

}  // namespace
}  // namespace picolo::target
