// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Virtual time, its counter, and the watchdog that lives in it.

#include <gtest/gtest.h>

#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_watchdog.hpp"

namespace picolo::sim {
namespace {

TEST(SimClock, GivenAnEarlierInstantThenItIsIgnored) {
  SimClock clock{Timestamp{5s}};
  clock.set(Timestamp{4s});
  EXPECT_EQ(clock.now(), Timestamp{5s});
  clock.advance(-1s);
  EXPECT_EQ(clock.now(), Timestamp{5s});
  clock.advance(1s);
  EXPECT_EQ(clock.now(), Timestamp{6s});
}

TEST(SimCycleCounter, CountsVirtualTimeAndWhatWasSpentAndWraps) {
  SimClock clock{Timestamp{Duration{4'294'967}}};  // 295 ns before 2^32 ns
  SimCycleCounter counter{clock};
  const std::uint32_t begin = counter.cycles();
  EXPECT_EQ(begin, 4'294'967'000U);
  counter.spend(500);
  EXPECT_EQ(counter.cycles() - begin, 500U);
  clock.advance(3us);
  EXPECT_EQ(counter.cycles() - begin, 3500U);
  EXPECT_EQ(counter.cycles_per_us(), 1000U);
}

TEST(SimWatchdog, GivenALateStrokeThenItHasExpiredForGood) {
  SimClock clock;
  SimWatchdog watchdog{clock, 100ms};
  clock.advance(100ms);
  EXPECT_FALSE(watchdog.expired());
  watchdog.stroke();
  clock.advance(101ms);
  EXPECT_TRUE(watchdog.expired());
  watchdog.stroke();
  EXPECT_TRUE(watchdog.expired());
  EXPECT_EQ(watchdog.strokes(), 2U);
}

}  // namespace
}  // namespace picolo::sim
