// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What happens when the cycle is late, a task is too long, or a task does not do its work.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fakes.hpp"

namespace picolo {
namespace {

using ::testing::ElementsAre;

TaskTable<3> table_with(OverrunPolicy policy) {
  return {TaskEntry{.name = "every", .budget = 1ms, .policy = policy},
          TaskEntry{.name = "fourth", .period_frames = 4, .offset_frames = 1, .budget = 1ms},
          TaskEntry{.name = "tenth", .period_frames = 10, .offset_frames = 9, .budget = 1ms}};
}

struct Late : ::testing::Test {
  Rig<3> rig{table_with(OverrunPolicy::carry_on)};
  const Timestamp start = rig.time.time;
  void SetUp() override { ASSERT_EQ(rig.executive.start(), Status::ok); }
  [[nodiscard]] const TaskCounters& counters(std::size_t task) const {
    return rig.executive.schedule().counters(task);
  }
  [[nodiscard]] const FrameCounters& frames() const {
    return rig.executive.schedule().frame_counters();
  }
};

TEST_F(Late, GivenLessThanTwoFramesLateThenOneFrameIsCaughtUpAndNothingIsLost) {
  rig.run_frames(3);
  rig.time.time = start + 15ms + 9ms;  // frame 3 is 9 ms late
  rig.run_frames(3);
  EXPECT_THAT(rig.tasks.frames_of(0), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(rig.tasks.runs[4].release, start + 15ms);
  EXPECT_EQ(frames().slipped, 0U);
  EXPECT_EQ(frames().worst_lateness, 9ms);
  EXPECT_EQ(counters(0).slips, 0U);
}

TEST_F(Late, GivenManyFramesLateThenOnlyTheNewestOverdueFrameIsCaughtUp) {
  rig.run_frames(2);
  rig.time.time = start + 42ms;  // frame 2 was due at 10 ms; 7 is overdue, 8 came due at 40 ms
  rig.run_frames(3);
  EXPECT_THAT(rig.tasks.frames_of(0), ElementsAre(0, 1, 7, 8, 9));
  EXPECT_EQ(frames().slipped, 5U);
  EXPECT_EQ(counters(0).slips, 5U);
  EXPECT_EQ(rig.executive.next_release(), start + 50ms) << "the grid is kept";
}

TEST_F(Late, GivenASlippedReleaseOfASlowTaskThenItRunsOnceInTheFrameThatIsRun) {
  rig.run_frames(2);
  rig.time.time = start + 62ms;  // frames 2..10 slip: "tenth" loses 9, "fourth" loses 5 and 9
  rig.run_frames(2);
  EXPECT_THAT(rig.tasks.frames_of(2), ElementsAre(11)) << "9 is made up once";
  EXPECT_EQ(counters(2).slips, 0U);
  EXPECT_THAT(rig.tasks.frames_of(1), ElementsAre(1, 11));
  EXPECT_EQ(counters(1).slips, 1U) << "5 and 9 came due, one was made up";
}

TEST_F(Late, GivenASlippedReleaseInAFrameWhereTheTaskIsDueAnywayThenItIsNotRunTwice) {
  rig.run_frames(2);
  rig.time.time = start + 51ms;  // frames 2..8 slip, 9 is run: "fourth" is due at 9 and lost 5
  rig.run_frames(1);
  EXPECT_THAT(rig.tasks.frames_of(1), ElementsAre(1, 9));
  EXPECT_EQ(counters(1).slips, 1U);
}

TEST_F(Late, GivenASlipAcrossManyMajorFramesThenTheNextWholeOneIsStroked) {
  rig.run_frames(20);
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U);
  rig.time.time = start + 100ms + 3s + 13ms;
  rig.run_frames(20);
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U) << "entered in the middle";
  rig.run_frames(20);
  EXPECT_EQ(rig.watchdog.strokes.size(), 2U);
  EXPECT_EQ(frames().slipped, 601U);
  EXPECT_EQ(frames().major_frames, 33U) << "30 slipped over after the first, and two more";
}

TEST_F(Late, GivenAFrameThatEndsAfterTheNextReleaseThenItIsCounted) {
  rig.tasks.length = [](auto, auto) { return 2ms; };
  rig.run_frames(9);  // only frame 9 runs all three... and 1, 5 run two: 4 ms
  EXPECT_EQ(frames().late_ends, 0U);
  rig.run_frames(1);
  EXPECT_EQ(frames().late_ends, 1U) << "6 ms of work in a frame of 5 ms";
}

TEST_F(Late, GivenATaskBeyondItsBudgetThenCarryOnOnlyCounts) {
  rig.tasks.length = [](std::size_t task, std::uint32_t frame) {
    return task == 0 && frame == 4 ? 1001us : 10us;
  };
  rig.run_frames(40);
  EXPECT_EQ(counters(0).overruns, 1U);
  EXPECT_EQ(counters(0).worst_cycles, 1001U);
  EXPECT_EQ(rig.executive.schedule().overruns(), 1U);
  EXPECT_EQ(counters(0).runs, 40U);
  EXPECT_EQ(rig.watchdog.strokes.size(), 2U);
}

TEST(OverrunPolicies, ExactlyTheBudgetIsNoOverrun) {
  Rig<3> rig{table_with(OverrunPolicy::fault)};
  ASSERT_EQ(rig.executive.start(), Status::ok);
  rig.tasks.length = [](auto, auto) { return 1000us; };
  rig.run_frames(20);
  EXPECT_EQ(rig.executive.schedule().overruns(), 0U);
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U);
}

TEST(OverrunPolicies, SkipNextLeavesOneReleaseOutAndStarvesThatMajorFrame) {
  Rig<3> rig{table_with(OverrunPolicy::skip_next)};
  ASSERT_EQ(rig.executive.start(), Status::ok);
  rig.tasks.length = [](std::size_t task, std::uint32_t frame) {
    return task == 0 && frame == 4 ? 2ms : 10us;
  };
  rig.run_frames(8);
  EXPECT_THAT(rig.tasks.frames_of(0), ElementsAre(0, 1, 2, 3, 4, 6, 7));
  EXPECT_THAT(rig.tasks.frames_of(1), ElementsAre(1, 5)) << "the others run";
  EXPECT_EQ(rig.executive.schedule().counters(0).skipped, 1U);
  rig.run_frames(12);
  EXPECT_TRUE(rig.watchdog.strokes.empty());
  rig.run_frames(20);
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U) << "the next major frame is whole again";
}

TEST(OverrunPolicies, FaultKeepsTheTasksRunningAndStarvesTheWatchdogForGood) {
  Rig<3> rig{table_with(OverrunPolicy::fault)};
  ASSERT_EQ(rig.executive.start(), Status::ok);
  rig.tasks.length = [](std::size_t task, std::uint32_t frame) {
    return task == 0 && frame == 25 ? 1500us : 10us;
  };
  rig.run_frames(100);
  EXPECT_TRUE(rig.executive.schedule().faulted());
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U);
  EXPECT_EQ(rig.executive.schedule().counters(0).runs, 100U);
}

TEST_F(Late, GivenATaskThatDoesNotDoItsWorkThenTheWatchdogStarvesInThatMajorFrameOnly) {
  rig.tasks.does_work = [](std::size_t task, std::uint32_t frame) {
    return !(task == 2 && frame == 29);
  };
  rig.run_frames(60);
  EXPECT_EQ(counters(2).unfinished, 1U);
  const std::vector<Timestamp>& strokes = rig.watchdog.strokes;
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_LT(strokes[0], start + 100ms);
  EXPECT_GT(strokes[1], start + 200ms);
}

TEST_F(Late, GivenOneSlippedFrameThenTheMajorFrameIsNotStroked) {
  rig.run_frames(5);
  rig.time.time = start + 25ms + 10ms;  // frame 5 slips, 6 and 7 follow at once
  rig.run_frames(14);
  EXPECT_EQ(rig.executive.next_release(), start + 100ms);
  EXPECT_TRUE(rig.watchdog.strokes.empty());
  rig.run_frames(20);
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U);
}

TEST_F(Late, WhenFaultedFromOutsideThenTheWatchdogStarves) {
  rig.executive.fault();
  rig.run_frames(40);
  EXPECT_TRUE(rig.watchdog.strokes.empty());
}

TEST_F(Late, GivenAnotherStartThenTheGridBeginsAnew) {
  rig.run_frames(7);
  rig.time.time += 123us;
  ASSERT_EQ(rig.executive.start(), Status::ok);
  EXPECT_EQ(rig.executive.next_release(), rig.time.time);
  rig.run_frames(20);
  EXPECT_EQ(rig.watchdog.strokes.size(), 1U) << "the interrupted major frame does not count";
}

}  // namespace
}  // namespace picolo
