// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What a task that spins does to a board: counted, handled by the policy of the table, and, where
// the policy or the length says so, ended by the watchdog. Everything is the real thing in QEMU:
// timer, SysTick, watchdog with its NMI, reset, and memory that survives it.

#include <gtest/gtest.h>

#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/last_words.hpp"
#include "platforms.hpp"

namespace picolo::target {
namespace {

constexpr std::int64_t kSerial = static_cast<std::int64_t>(ControllerTask::serial);
// Of the image `overrun`: ticks, and the frame at the start.
constexpr std::int64_t kFrames = 241;
constexpr std::int64_t kMajorFrames = 12;

/// The port of the task `serial` spins in `spins` frames, from frame 50 on. It may take 200 us.
Figures overrun(const Platform& platform, const std::string& policy, int spins, int spin_us) {
  const Outcome outcome =
      run(platform, "overrun", {policy, std::to_string(spins), std::to_string(spin_us)},
          "-icount shift=2,sleep=off");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return figures_in(outcome.output);
}

/// Whatever spun, no other task overran.
void expect_overruns(Figures& figures, std::int64_t serial) {
  for (const auto& [name, value] : figures) {
    if (name.starts_with("overruns_")) {
      EXPECT_EQ(value, name == "overruns_serial" ? serial : 0) << name;
    }
  }
}

/// Nothing but the overruns is out of order.
void expect_a_board_that_went_on(Figures& figures, std::int64_t overruns) {
  expect_overruns(figures, overruns);
  EXPECT_EQ(figures["overrun_events"], overruns);
  EXPECT_EQ(figures["overrun_task"], kSerial);
  EXPECT_EQ(figures["reset_events"], 0);
  EXPECT_EQ(figures["faulted"], 0);
  EXPECT_EQ(figures["major_frames"], kMajorFrames);
}

/// Told by the run after the reset, which itself is in order.
void expect_a_reset(Figures& figures, ResetCause cause) {
  EXPECT_EQ(figures["reset_task"], kSerial);
  EXPECT_EQ(figures["reset_cause"], static_cast<std::int64_t>(cause));
  EXPECT_EQ(figures["resets"], 1);
  EXPECT_EQ(figures["reset_events"], 1);
  EXPECT_EQ(figures["reset_event_task"], kSerial);
  EXPECT_EQ(figures["store_survived"], 1);
  expect_overruns(figures, 0);
  EXPECT_EQ(figures["frames"], 61);
  EXPECT_EQ(figures["slipped"], 0);
  EXPECT_EQ(figures["strokes"], 3);
}

struct Overrun : ::testing::Test {
  void for_each_board(void (*judge)(const Platform&)) {
    PICOLO_NEED_IMAGES();
    int boards = 0;
    for (const Platform& platform : platforms_to_judge()) {
      if (!std::filesystem::exists(image(platform, "overrun"))) { continue; }
      SCOPED_TRACE(platform.name);
      judge(platform);
      ++boards;
    }
    if (boards == 0) { GTEST_SKIP() << "no board with a watchdog was built"; }
  }
};

TEST_F(Overrun, CarryOnOnlyCounts) {
  for_each_board([](const Platform& platform) {
    Figures figures = overrun(platform, "carry_on", 10, 1000);
    expect_a_board_that_went_on(figures, 10);
    EXPECT_EQ(figures["frames"], kFrames);
    EXPECT_EQ(figures["serial_runs"], kFrames);
    EXPECT_EQ(figures["strokes"], kMajorFrames);
    EXPECT_EQ(figures["late_ends"], 0);
    EXPECT_GE(figures["serial_worst_us"], 1000);
    EXPECT_LT(figures["serial_worst_us"], 1020);
  });
}

TEST_F(Overrun, OfMoreThanThreeFramesSlipsOneAndSpoilsOneStroke) {
  for_each_board([](const Platform& platform) {
    Figures figures = overrun(platform, "carry_on", 1, 17'000);  // 12 ms late: 2 frames, 1 runs
    expect_a_board_that_went_on(figures, 1);
    EXPECT_EQ(figures["slipped"], 1);
    EXPECT_EQ(figures["frames"], kFrames - 1);
    EXPECT_EQ(figures["serial_slips"], 1);
    EXPECT_EQ(figures["strokes"], kMajorFrames - 1);
    EXPECT_GE(figures["worst_lateness_us"], 7'000) << "the frame before the slipped one";
  });
}

TEST_F(Overrun, SkipNextLeavesOutOneReleaseForEach) {
  for_each_board([](const Platform& platform) {
    Figures figures = overrun(platform, "skip_next", 10, 1000);  // in frames 50, 52 ... 68
    expect_a_board_that_went_on(figures, 10);
    EXPECT_EQ(figures["frames"], kFrames);
    EXPECT_EQ(figures["serial_skipped"], 10);
    EXPECT_EQ(figures["serial_runs"], kFrames - 10);
    EXPECT_EQ(figures["slipped"], 0);
    EXPECT_EQ(figures["strokes"], kMajorFrames - 2) << "the two that were not complete";
  });
}

TEST_F(Overrun, SkipNextWithoutEndStarvesTheWatchdog) {
  for_each_board([](const Platform& platform) {
    Figures figures = overrun(platform, "skip_next", 1000, 1000);
    expect_a_reset(figures, ResetCause::starved);
    EXPECT_EQ(figures["reset_slipped"], 0);
    EXPECT_GT(figures["reset_overruns"], 20) << "it went on until the watchdog barked";
    EXPECT_EQ(figures["overrun_events"], figures["reset_overruns"]);
  });
}

TEST_F(Overrun, FaultGoesOnUntilTheWatchdogResetsTheBoard) {
  for_each_board([](const Platform& platform) {
    Figures figures = overrun(platform, "fault", 1, 1000);
    expect_a_reset(figures, ResetCause::fault);
    EXPECT_EQ(figures["reset_overruns"], 1);
    EXPECT_EQ(figures["reset_slipped"], 0);
    // Stroked after frame 39, barked 350 ms later.
    EXPECT_NEAR(static_cast<double>(figures["reset_frames"]), 39 + 70, 1);
  });
}

TEST_F(Overrun, ATaskThatNeverReturnsIsNamedAfterTheReset) {
  for_each_board([](const Platform& platform) {
    Figures figures = overrun(platform, "carry_on", 1, 0);
    expect_a_reset(figures, ResetCause::stuck);
    EXPECT_EQ(figures["reset_frames"], 50);
    EXPECT_EQ(figures["reset_overruns"], 0) << "it has not ended";
  });
}

}  // namespace
}  // namespace picolo::target
