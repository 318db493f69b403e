// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "picolo/executive/task.hpp"

namespace picolo {
namespace {

// A table is checked where it is written: at compile time.
constexpr ExecutiveConfig kCycle{};
constexpr TaskTable<2> kGood{TaskEntry{.name = "every", .budget = 2ms},
                             TaskEntry{.name = "fifth", .period_frames = 5, .budget = 3ms}};
static_assert(kCycle.valid() && kCycle.frames() == 20);
static_assert(valid_table(kCycle, kGood));
static_assert(worst_frame_budget(kCycle, kGood) == 5ms);

TaskTable<2> changed(void (*change)(TaskEntry&)) {
  TaskTable<2> table = kGood;
  change(table[1]);
  return table;
}

TEST(TaskTable, GivenABadEntryThenRefused) {
  EXPECT_TRUE(valid_table(kCycle, changed([](TaskEntry&) {})));
  EXPECT_FALSE(valid_table(kCycle, changed([](TaskEntry& t) { t.period_frames = 0; })));
  EXPECT_FALSE(valid_table(kCycle, changed([](TaskEntry& t) { t.period_frames = 3; })))
      << "20 frames are no multiple of 3: the pattern would not repeat";
  EXPECT_FALSE(valid_table(kCycle, changed([](TaskEntry& t) { t.offset_frames = 5; })));
  EXPECT_FALSE(valid_table(kCycle, changed([](TaskEntry& t) { t.budget = 0us; })));
  EXPECT_FALSE(valid_table(kCycle, changed([](TaskEntry& t) { t.name = nullptr; })));
  EXPECT_FALSE(valid_table(kCycle, {}));
}

TEST(TaskTable, GivenBudgetsBeyondTheFullestFrameThenRefused) {
  const auto too_long = changed([](TaskEntry& t) { t.budget = 3001us; });
  EXPECT_EQ(worst_frame_budget(kCycle, too_long), 5001us);
  EXPECT_FALSE(valid_table(kCycle, too_long));
}

TEST(TaskTable, GivenOffsetsThatKeepTasksApartThenTheirBudgetsDoNotAddUp) {
  constexpr TaskTable<2> kApart{
      TaskEntry{.name = "even", .period_frames = 2, .offset_frames = 0, .budget = 4ms},
      TaskEntry{.name = "odd", .period_frames = 2, .offset_frames = 1, .budget = 3ms}};
  EXPECT_EQ(worst_frame_budget(kCycle, kApart), 4ms);
}

TEST(TaskTable, GivenAlternativesThenTheLongestOfThemCounts) {
  constexpr TaskTable<4> kShared{TaskEntry{.name = "first", .budget = 2ms},
                                 TaskEntry{.name = "or", .budget = 3ms, .alternative = true},
                                 TaskEntry{.name = "or else", .budget = 1ms, .alternative = true},
                                 TaskEntry{.name = "besides", .budget = 1ms}};
  EXPECT_EQ(worst_frame_budget(kCycle, kShared), 4ms);
}

TEST(ExecutiveConfig, GivenFramesThatDoNotFitIntoEachOtherThenRefused) {
  EXPECT_FALSE((ExecutiveConfig{.minor_frame = 0us}.valid()));
  EXPECT_FALSE((ExecutiveConfig{.minor_frame = 3ms, .major_frame = 100ms}.valid()));
  EXPECT_FALSE((ExecutiveConfig{.minor_frame = 200ms, .major_frame = 100ms}.valid()));
  EXPECT_TRUE((ExecutiveConfig{.minor_frame = 10ms, .major_frame = 10ms}.valid()));
}

}  // namespace
}  // namespace picolo
