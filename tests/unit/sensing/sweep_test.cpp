// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The assembler cuts a stream of readings into revolutions and counts everything that it leaves
// out.

#include "picolo/sensing/sweep.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>

namespace picolo {
namespace {

constexpr Duration kSpacing = 1ms;

/// A lidar of `beams` readings a revolution, one a millisecond, whose range tells its number.
template <std::size_t Capacity = 64>
class Spinning {
 public:
  explicit Spinning(const SweepAssemblerConfig& config = {}) : assembler(config) {}

  void reading(bool starts_sweep, bool ends_sweep = false) {
    ++number;
    now += kSpacing;
    assembler.add({.stamp = now,
                   .range_m = static_cast<float>(number),
                   .bearing_rad = 0.25F,
                   .starts_sweep = starts_sweep,
                   .ends_sweep = ends_sweep});
  }

  void revolution(int beams) {
    for (int i = 0; i < beams; ++i) { reading(i == 0); }
  }

  SweepAssembler<Capacity> assembler;
  Timestamp now{10s};
  int number = 0;
};

TEST(SweepAssembler, ARevolutionThatTellsItsEndIsCompleteThereHoweverLateTheNextOneComes) {
  Spinning<20> lidar;
  for (std::uint32_t turn = 0; turn < 3; ++turn) {
    lidar.now += 500ms;
    for (int i = 0; i < 22; ++i) { lidar.reading(i == 0, i == 21); }  // two find no room
    ASSERT_TRUE(lidar.assembler.ready());
    const Sweep sweep = lidar.assembler.take();
    EXPECT_EQ(sweep.sequence, turn);
    EXPECT_EQ(sweep.returns.size(), 20U);
    EXPECT_EQ(sweep.last_stamp, lidar.now - 2ms);
  }
  EXPECT_EQ(lidar.assembler.counters().partial, 0U);
  EXPECT_EQ(lidar.assembler.counters().overflowed, 6U);
  lidar.reading(false);
  EXPECT_EQ(lidar.assembler.counters().partial, 1U) << "of no revolution";
  lidar.revolution(20);
  lidar.reading(true);
  EXPECT_TRUE(lidar.assembler.ready());
}

TEST(SweepAssembler, ARevolutionIsCompleteWhenTheNextOneStarts) {
  Spinning lidar;
  lidar.revolution(20);
  EXPECT_FALSE(lidar.assembler.ready());
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());

  const Sweep sweep = lidar.assembler.take();
  EXPECT_FALSE(lidar.assembler.ready());
  EXPECT_EQ(sweep.stamp, Timestamp{10s + 1ms});
  EXPECT_EQ(sweep.last_stamp, Timestamp{10s + 20ms});
  EXPECT_EQ(sweep.sequence, 0U);
  ASSERT_EQ(sweep.returns.size(), 20U);
  for (std::size_t i = 0; i < sweep.returns.size(); ++i) {
    EXPECT_EQ(sweep.returns[i].range_m, static_cast<float>(i + 1));
    EXPECT_EQ(sweep.returns[i].bearing_rad, 0.25F);
    EXPECT_FLOAT_EQ(sweep.returns[i].since_sweep_start_s, 0.001F * static_cast<float>(i));
  }
  EXPECT_EQ(lidar.assembler.counters().completed, 1U);
  EXPECT_EQ(lidar.assembler.counters().partial, 0U);
}

TEST(SweepAssembler, TheFirstRevolutionIsDroppedWhenItsBeginningWasNotSeen) {
  Spinning lidar;
  for (int i = 0; i < 30; ++i) { lidar.reading(false); }
  lidar.revolution(20);
  EXPECT_FALSE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.counters().partial, 1U);
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.take().returns.front().range_m, 31.0F);
  EXPECT_EQ(lidar.assembler.counters().completed, 1U);
}

TEST(SweepAssembler, ARevolutionWithTooFewReadingsIsPartial) {
  Spinning lidar{{.min_readings = 16}};
  lidar.revolution(15);
  lidar.revolution(16);
  EXPECT_FALSE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.counters().partial, 1U);
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.take().returns.size(), 16U);
}

TEST(SweepAssembler, ASilenceInsideDropsTheRevolutionOnce) {
  Spinning lidar{{.max_gap = 50ms}};
  lidar.revolution(20);
  lidar.now += 50ms;  // 51 ms after the last reading
  for (int i = 0; i < 20; ++i) { lidar.reading(false); }
  EXPECT_EQ(lidar.assembler.counters().partial, 1U);
  lidar.revolution(20);
  EXPECT_FALSE(lidar.assembler.ready());
  lidar.reading(true);
  EXPECT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.counters().partial, 1U);
  EXPECT_EQ(lidar.assembler.counters().completed, 1U);
}

TEST(SweepAssembler, ASilenceAsLongAsAllowedIsNoGap) {
  Spinning lidar{{.max_gap = 50ms}};
  lidar.revolution(20);
  lidar.now += 49ms;
  lidar.reading(false);
  lidar.reading(true);
  EXPECT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.counters().partial, 0U);
}

TEST(SweepAssembler, ASilenceBeforeTheNextStartDropsTheRevolutionThatMayLackItsEnd) {
  Spinning lidar{{.max_gap = 50ms}};
  lidar.revolution(20);
  lidar.now += 60ms;
  lidar.revolution(20);
  EXPECT_FALSE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.counters().partial, 1U);
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.take().returns.front().range_m, 21.0F);
}

TEST(SweepAssembler, ReadingsBeyondTheCapacityAreCountedAndTheStampIsOfTheLastKept) {
  Spinning<32> lidar;
  lidar.revolution(40);
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());
  const Sweep sweep = lidar.assembler.take();
  EXPECT_EQ(sweep.returns.size(), 32U);
  EXPECT_EQ(lidar.assembler.counters().overflowed, 8U);
  EXPECT_EQ(sweep.last_stamp, Timestamp{10s + 32ms});
  EXPECT_FLOAT_EQ(sweep.returns.back().since_sweep_start_s,
                  to_seconds(sweep.last_stamp - sweep.stamp));
}

TEST(SweepAssembler, AReadingOlderThanItsPredecessorIsDropped) {
  Spinning lidar;
  lidar.revolution(20);
  lidar.now -= 5ms;
  for (int i = 0; i < 4; ++i) { lidar.reading(false); }
  EXPECT_EQ(lidar.assembler.counters().out_of_order, 4U);
  lidar.reading(false);  // as late as the newest: kept
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.take().returns.size(), 21U);
}

TEST(SweepAssembler, AStartIsAStartEvenWhenItsStampIsALittleOld) {
  Spinning lidar;
  lidar.revolution(20);
  lidar.now -= 3ms;
  lidar.revolution(20);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.take().returns.size(), 20U);
  EXPECT_EQ(lidar.assembler.counters().out_of_order, 1U);
  lidar.reading(true);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.take().returns.size(), 20U);
}

TEST(SweepAssembler, RecoversWhenTheClockBehindTheStampsWasSetBack) {
  Spinning lidar;
  lidar.revolution(20);
  lidar.now -= 5s;
  lidar.reading(false);
  lidar.revolution(20);
  lidar.revolution(20);
  ASSERT_TRUE(lidar.assembler.ready());
  EXPECT_EQ(lidar.assembler.counters().completed, 1U);
  EXPECT_EQ(lidar.assembler.counters().partial, 1U);
  EXPECT_EQ(lidar.assembler.counters().out_of_order, 1U);
}

TEST(SweepAssembler, ASweepThatNobodyTakesIsReplacedAndTheSequenceTells) {
  Spinning lidar;
  lidar.revolution(20);
  lidar.revolution(21);
  lidar.revolution(22);
  lidar.reading(true);
  EXPECT_EQ(lidar.assembler.counters().replaced, 2U);
  const Sweep sweep = lidar.assembler.take();
  EXPECT_EQ(sweep.returns.size(), 22U);
  EXPECT_EQ(sweep.sequence, 2U);
}

TEST(SweepAssembler, ATakenSweepStaysWholeWhileTheNextOneFills) {
  Spinning lidar;
  lidar.revolution(20);
  lidar.reading(true);
  const Sweep sweep = lidar.assembler.take();
  for (int i = 0; i < 30; ++i) { lidar.reading(false); }
  ASSERT_EQ(sweep.returns.size(), 20U);
  for (std::size_t i = 0; i < sweep.returns.size(); ++i) {
    EXPECT_EQ(sweep.returns[i].range_m, static_cast<float>(i + 1));
  }
}

TEST(SweepAssembler, TakingWithoutASweepGivesAnEmptyOne) {
  SweepAssembler<16> assembler;
  EXPECT_TRUE(assembler.take().returns.empty());
}

TEST(SweepAssembler, InvalidRangesAreKeptForTheirTime) {
  SweepAssembler<64> assembler{{.min_readings = 1}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  assembler.add({.stamp = Timestamp{1ms}, .range_m = 0.0F, .starts_sweep = true});
  assembler.add({.stamp = Timestamp{2ms}, .range_m = nan});
  assembler.add({.stamp = Timestamp{3ms}, .range_m = 1.0F, .starts_sweep = true});
  ASSERT_TRUE(assembler.ready());
  EXPECT_EQ(assembler.take().returns.size(), 2U);
}

TEST(SweepAssemblerConfig, KnowsItsDomain) {
  EXPECT_TRUE(SweepAssemblerConfig{}.valid());
  EXPECT_FALSE((SweepAssemblerConfig{.max_gap = Duration{0}}.valid()));
  EXPECT_FALSE((SweepAssemblerConfig{.min_readings = 0}.valid()));
}

TEST(RangeLimits, OnlyFiniteRangesInsideAreMeasurements) {
  constexpr RangeLimits kLimits{.min_m = 0.1F, .max_m = 12.0F};
  static_assert(kLimits.valid());
  EXPECT_TRUE(kLimits.contains(0.1F));
  EXPECT_TRUE(kLimits.contains(12.0F));
  EXPECT_FALSE(kLimits.contains(0.0F));
  EXPECT_FALSE(kLimits.contains(12.001F));
  EXPECT_FALSE(kLimits.contains(std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(kLimits.contains(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE((RangeLimits{.min_m = 2.0F, .max_m = 1.0F}.valid()));
  EXPECT_FALSE((RangeLimits{.min_m = 0.0F, .max_m = 1.0F}.valid()));
}

}  // namespace
}  // namespace picolo
