// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/executive/executive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fakes.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo {
namespace {

using ::testing::ElementsAre;

static_assert(TimeSource<Clock> && CycleSource<CycleCounter> && WatchdogLike<Watchdog>,
              "the HAL's interfaces are what the executive asks for");

constexpr TaskTable<3> kTable{
    TaskEntry{.name = "every", .work_bound = 7, .budget = 1ms},
    TaskEntry{.name = "second", .period_frames = 2, .offset_frames = 1, .budget = 1ms},
    TaskEntry{.name = "fifth", .period_frames = 5, .offset_frames = 3, .budget = 1ms}};

TEST(Executive, GivenNotStartedThenNothingRuns) {
  Rig rig{kTable};
  rig.time.time += 1s;
  EXPECT_EQ(rig.executive.run_frame(rig.tasks), Status::not_ready);
  EXPECT_TRUE(rig.tasks.runs.empty());
}

TEST(Executive, GivenATableThatCannotBeKeptThenStartRefuses) {
  TaskTable<3> table = kTable;
  table[0].budget = 4ms;
  Rig rig{table};
  EXPECT_EQ(rig.executive.start(), Status::invalid_argument);
  EXPECT_EQ(rig.executive.run_frame(rig.tasks), Status::not_ready);
}

TEST(Executive, GivenPeriodsAndOffsetsThenTasksRunInTheirFramesInTableOrder) {
  Rig rig{kTable};
  ASSERT_EQ(rig.executive.start(), Status::ok);
  rig.run_frames(10);
  EXPECT_THAT(rig.tasks.frames_of(0), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(rig.tasks.frames_of(1), ElementsAre(1, 3, 5, 7, 9));
  EXPECT_THAT(rig.tasks.frames_of(2), ElementsAre(3, 8));
  std::vector<std::size_t> of_frame_3;
  for (const TaskRun& run : rig.tasks.runs) {
    if (run.frame == 3) { of_frame_3.push_back(run.task); }
  }
  EXPECT_THAT(of_frame_3, ElementsAre(0, 1, 2));
  EXPECT_EQ(rig.tasks.runs.front().work_bound, 7U);
}

TEST(Executive, WhenCalledEarlyThenNotReadyAndNothingRuns) {
  Rig rig{kTable};
  ASSERT_EQ(rig.executive.start(), Status::ok);
  EXPECT_EQ(rig.executive.run_frame(rig.tasks), Status::ok);
  rig.time.time = rig.executive.next_release() - 1us;
  EXPECT_EQ(rig.executive.run_frame(rig.tasks), Status::not_ready);
  rig.time.time += 1us;
  EXPECT_EQ(rig.executive.run_frame(rig.tasks), Status::ok);
}

TEST(Executive, GivenTenMinutesOfJitteryWakeUpsThenReleasesDoNotDrift) {
  Rig rig{kTable};
  const Timestamp start = rig.time.time;
  ASSERT_EQ(rig.executive.start(), Status::ok);
  constexpr std::uint32_t kFrames = 10 * 60 * 200;
  std::uint32_t state = 1;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    state = state * 1664525U + 1013904223U;
    rig.time.time = std::max(rig.time.time, rig.executive.next_release()) + Duration{state >> 20};
    ASSERT_EQ(rig.executive.run_frame(rig.tasks), Status::ok);
    ASSERT_EQ(rig.tasks.runs.back().release, start + frame * 5ms);
    rig.tasks.runs.resize(1);
  }
  EXPECT_EQ(rig.executive.next_release(), start + 10min);
  const FrameCounters& frames = rig.executive.schedule().frame_counters();
  EXPECT_EQ(frames.frames, kFrames);
  EXPECT_EQ(frames.slipped, 0U);
  EXPECT_EQ(frames.strokes, kFrames / 20);
  EXPECT_EQ(rig.watchdog.strokes.size(), kFrames / 20);
}

TEST(Executive, AllTasksOfAFrameSeeTheSameTime) {
  Rig rig{kTable};
  ASSERT_EQ(rig.executive.start(), Status::ok);
  rig.run_frames(4);
  for (const TaskRun& run : rig.tasks.runs) { EXPECT_EQ(run.start, run.release); }
}

TEST(Executive, CyclesOfRunsAreCountedAndObserved) {
  struct Observer {
    std::vector<std::pair<std::size_t, std::uint32_t>> seen;
    void ran(std::size_t task, std::uint32_t cycles) { seen.emplace_back(task, cycles); }
  } observer;
  Rig rig{kTable};
  rig.tasks.length = [](std::size_t task, std::uint32_t frame) {
    return task == 0 ? Duration{100 + 50 * (frame % 2)} : Duration{30};
  };
  ASSERT_EQ(rig.executive.start(), Status::ok);
  for (int i = 0; i < 3; ++i) {
    rig.time.time = std::max(rig.time.time, rig.executive.next_release());
    ASSERT_EQ(rig.executive.run_frame(rig.tasks, observer), Status::ok);
  }
  const TaskCounters& every = rig.executive.schedule().counters(0);
  EXPECT_EQ(every.runs, 3U);
  EXPECT_EQ(every.last_cycles, 100U);
  EXPECT_EQ(every.worst_cycles, 150U);
  EXPECT_EQ(every.overruns, 0U);
  const std::vector<std::pair<std::size_t, std::uint32_t>> expected{
      {0, 100}, {0, 150}, {1, 30}, {0, 100}};
  EXPECT_EQ(observer.seen, expected);
}

TEST(Executive, GivenACycleCounterThatWrapsThenTheLengthIsRight) {
  Rig rig{kTable};
  rig.time.time = Timestamp{Duration{0xFFFF'FFFFLL - 40}};
  rig.tasks.length = [](auto, auto) { return 100us; };
  ASSERT_EQ(rig.executive.start(), Status::ok);
  rig.run_frames(1);
  EXPECT_EQ(rig.executive.schedule().counters(0).last_cycles, 100U);
}

}  // namespace
}  // namespace picolo
