// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/last_words.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace picolo {
namespace {

/// Two tasks, of which the second may not overrun.
struct Bark : ::testing::Test {
  static constexpr Timestamp kStart{7s};
  const TaskTable<2> table{
      TaskEntry{.name = "first", .budget = 1ms},
      TaskEntry{.name = "second", .budget = 1ms, .policy = OverrunPolicy::fault}};
  std::array<TaskState, 2> states{};
  Schedule schedule{ExecutiveConfig{}, table, states};
  EventRing events{};
  LastWords words{};

  void SetUp() override {
    ASSERT_EQ(schedule.start(kStart), Status::ok);
    // What power brings: no seal holds.
    std::memset(static_cast<void*>(&words), 0xA5, sizeof words);
    ASSERT_EQ(words.take(events).status(), Status::not_ready);
    EXPECT_FALSE(events.attach());
  }
  void begin_frame() { ASSERT_TRUE(schedule.begin_frame(kStart)); }
  void run(std::size_t task, Duration time) {
    ASSERT_TRUE(schedule.take(task));
    schedule.finish(task, time, 1, true);
  }
  /// The early warning, then the reset.
  ResetReport bark(Timestamp now) {
    words.note(schedule, now);
    const Result<ResetReport> report = words.take(events);
    EXPECT_TRUE(report);
    EXPECT_EQ(words.take(events).status(), Status::not_ready) << "told once";
    EXPECT_EQ(events[events.size() - 1].code, EventCode::watchdog_reset);
    return report.value_or(ResetReport{});
  }
  [[nodiscard]] std::int32_t event_argument() const { return events[events.size() - 1].argument; }
};

TEST_F(Bark, InsideOfATaskThatDoesNotReturn) {
  begin_frame();
  run(0, 2ms);
  ASSERT_TRUE(schedule.take(1));
  const ResetReport report = bark(kStart + 300ms);
  EXPECT_EQ(report.cause, ResetCause::stuck);
  EXPECT_EQ(report.task, 1);
  EXPECT_EQ(report.overruns, 1U);
  EXPECT_EQ(event_argument(), 1);
}

TEST_F(Bark, InsideOfATaskThatIsInTimeBlamesTheOneThatOverranLast) {
  begin_frame();
  run(0, 2ms);
  ASSERT_TRUE(schedule.take(1));
  const ResetReport report = bark(kStart + 3ms);
  EXPECT_EQ(report.cause, ResetCause::starved);
  EXPECT_EQ(report.task, 0);
}

TEST_F(Bark, AfterAFaultBlamesTheTaskThatFaultedWhoeverOverranLater) {
  begin_frame();
  run(1, 2ms);
  run(0, 2ms);
  static_cast<void>(schedule.end_frame(kStart + 4ms));
  const ResetReport report = bark(kStart + 300ms);
  EXPECT_EQ(report.cause, ResetCause::fault);
  EXPECT_EQ(report.task, 1);
  EXPECT_EQ(report.frames, 1U);
  EXPECT_EQ(report.overruns, 2U);
}

TEST_F(Bark, WhenNobodyCallsTheCycleBlamesNoTaskAndCountsItsResets) {
  EXPECT_EQ(bark(kStart + 300ms).resets, 1U);
  const ResetReport report = bark(kStart + 300ms);
  EXPECT_EQ(report.cause, ResetCause::starved);
  EXPECT_EQ(report.task, Schedule::kNoTask);
  EXPECT_EQ(report.resets, 2U);
  EXPECT_EQ(event_argument(), -1);
}

}  // namespace
}  // namespace picolo
