// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The whole robot on a board that runs by its own clock: bytes through UARTs and their interrupts,
// CAN through a UART, cycles by SysTick. Judged by its error to the truth and by counters.

#include <gtest/gtest.h>

#include <iostream>

#include "free_drive.hpp"
#include "picolo/localisation/pose_estimate.hpp"
#include "support/files.hpp"

namespace picolo::target {
namespace {

/// No sweep is worked on while a map is saved: 2 sectors of 45 ms, and about 40 frames of writing
/// and reading back.
constexpr int kSweepsOfASave = 6;

TEST(FreeRunning, ABoardDrivesByItsOwnClock) {
  PICOLO_NEED_IMAGES();
  const test::TemporaryFolder folder;
  FreeDrivePlan plan{.asks = {{2s, {.kind = CommandKind::start_calibration}},
                              {2500ms, {.kind = CommandKind::abort_calibration}},
                              {3s, {.kind = CommandKind::save_map}}},
                     .erase_time = 45ms};
  std::cout << "| board | cycles | slipped | overruns | worst lateness | bytes lost | matches | "
               "pose frames | worst error |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Platform& platform : boards_with_devices()) {
    SCOPED_TRACE(platform.name);
    plan.flash_file = folder.file(platform.preset);
    FreeDrive drive = drive_freely(platform, plan);
    auto& figures = drive.figures;
    const std::int64_t lost = bytes_lost(figures);
    std::cout << "| " << platform.name << " | " << figures["frames"] << " | " << figures["slipped"]
              << " | " << overruns_in(figures) << " | " << figures["worst_lateness_us"] << " us | "
              << lost << " | " << figures["matches"] << " | " << drive.poses << " | "
              << drive.worst_error_m << " m |\n";
    ASSERT_EQ(drive.trouble, "");
    EXPECT_EQ(lost, 0);
    EXPECT_EQ(figures["malformed_lines"], 0);
    EXPECT_EQ(drive.damaged_lines, 0U);
    EXPECT_EQ(figures["bad_checksums"], 0);
    EXPECT_EQ(figures["frames_refused"], 0);
    // Every cycle, in spite of the wrap of the clock's counter and of the flash at work.
    EXPECT_GE(figures["frames"], plan.seconds * 200);
    EXPECT_EQ(figures["slipped"], 0);
    EXPECT_EQ(figures["late_ends"], 0);
    EXPECT_EQ(overruns_in(figures), 0);
    EXPECT_GE(figures["matches"], plan.seconds * 10 - 3 - kSweepsOfASave);
    EXPECT_GE(figures["strokes"], plan.seconds * 10 - 1);
    EXPECT_GT(figures["readings"], plan.seconds * 4400);
    EXPECT_GT(figures["imu_samples"], plan.seconds * 98);
    EXPECT_GT(figures["ticks"], plan.seconds * 95);
    EXPECT_GE(drive.poses, static_cast<std::uint32_t>(plan.seconds) * 39);
    EXPECT_EQ(figures["state"], static_cast<int>(HealthState::tracking));
    EXPECT_GT(drive.driven_m, 0.5);
    EXPECT_LT(drive.worst_error_m, 0.05);
    // The calibration routine is reached over CAN; a map is saved while the vehicle drives.
    EXPECT_EQ(drive.answers, (std::vector{CommandResult::done, CommandResult::done,
                                          CommandResult::started, CommandResult::done}));
    EXPECT_GT(drive.calibration_frames, 0U);
    EXPECT_GT(figures["erases"], 0);
    expect_map_kept(plan, drive);
  }
}

}  // namespace
}  // namespace picolo::target
