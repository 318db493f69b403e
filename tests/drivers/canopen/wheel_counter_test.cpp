// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/wheel_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/property.hpp"

namespace picolo::test {
namespace {

using canopen::WheelCounter;
using canopen::WheelCounterConfig;
using Step = WheelCounter::Step;

static_assert(WheelCounterConfig{}.valid());
static_assert(!WheelCounterConfig{.modulus = 1}.valid());
static_assert(!WheelCounterConfig{.modulus = (1ULL << 32) + 1}.valid());

TEST(WheelCounter, GivenTheFirstPositionThenItIsTheBaseAndTheCountStartsAtZero) {
  WheelCounter counter;
  EXPECT_EQ(counter.update(Timestamp{1s}, 123456), Step::rebased);
  EXPECT_EQ(counter.ticks(), 0);
  EXPECT_EQ(counter.update(Timestamp{1s} + 10ms, 123450), Step::moved);
  EXPECT_EQ(counter.ticks(), -6);
}

TEST(WheelCounter, GivenThe32BitBorderThenTheCountGoesOnInBothDirections) {
  WheelCounter counter;
  static_cast<void>(counter.update(Timestamp{1s}, INT32_MAX - 5));
  EXPECT_EQ(counter.update(Timestamp{1s} + 10ms, INT32_MIN + 4), Step::moved);
  EXPECT_EQ(counter.ticks(), 10);
  static_cast<void>(counter.update(Timestamp{1s} + 20ms, INT32_MAX));
  EXPECT_EQ(counter.ticks(), 5);
}

TEST(WheelCounter, PropertyAnyModulusAnyWalkTheCountIsTheWalk) {
  EXPECT_TRUE(rc::check([] {
    const auto modulus = *rc::gen::inRange<std::uint64_t>(7, (1ULL << 32) + 1);
    const bool inverted = *rc::gen::arbitrary<bool>();
    const bool as_signed = *rc::gen::arbitrary<bool>();
    const auto range = static_cast<std::int64_t>(modulus);
    const auto reach = std::min<std::int64_t>((range - 1) / 2, 1'000'000);
    const auto steps = *rc::gen::container<std::vector<std::int64_t>>(
        rc::gen::inRange<std::int64_t>(-reach, reach + 1));
    WheelCounter counter{WheelCounterConfig{.modulus = modulus, .inverted = inverted}};
    std::int64_t position = *rc::gen::inRange<std::int64_t>(0, range);
    std::int64_t walked = 0;
    Timestamp stamp{1s};
    static_cast<void>(counter.update(stamp, position));
    for (const std::int64_t step : steps) {
      stamp += 10ms;
      walked += step;
      position = ((position + step) % range + range) % range;
      const std::int64_t shown = as_signed && position >= range / 2 ? position - range : position;
      RC_ASSERT(counter.update(stamp, shown) == Step::moved);
      RC_ASSERT(counter.ticks() == (inverted ? -walked : walked));
    }
  }));
}

TEST(WheelCounter, GivenAPositionOutsideOfTheModulusThenItIsIgnored) {
  WheelCounter counter{WheelCounterConfig{.modulus = 10'000}};
  static_cast<void>(counter.update(Timestamp{1s}, 5));
  EXPECT_EQ(counter.update(Timestamp{1s} + 10ms, 10'000), Step::out_of_range);
  EXPECT_EQ(counter.update(Timestamp{1s} + 10ms, -10'001), Step::out_of_range);
  EXPECT_EQ(counter.update(Timestamp{1s} + 20ms, 9'999), Step::moved);
  EXPECT_EQ(counter.ticks(), -6);
}

TEST(WheelCounter, GivenAnAnnouncedRestartThenTheJumpIsDroppedAndTheCountGoesOn) {
  WheelCounter counter;
  static_cast<void>(counter.update(Timestamp{1s}, 5000));
  static_cast<void>(counter.update(Timestamp{1s} + 10ms, 5100));
  counter.expect_restart();
  EXPECT_EQ(counter.update(Timestamp{2s}, 0), Step::rebased);
  EXPECT_EQ(counter.ticks(), 100);
  EXPECT_EQ(counter.update(Timestamp{2s} + 10ms, 7), Step::moved);
  EXPECT_EQ(counter.ticks(), 107);
}

TEST(WheelCounter, GivenASpeedLimitThenARestartThatNobodyAnnouncedIsFound) {
  WheelCounter counter{WheelCounterConfig{.max_counts_per_s = 10'000}};
  static_cast<void>(counter.update(Timestamp{1s}, 50'000));
  EXPECT_EQ(counter.update(Timestamp{1s} + 10ms, 50'600),
            Step::moved);  // 10 ms and 50 ms of jitter
  EXPECT_EQ(counter.update(Timestamp{1s} + 20ms, 51'201), Step::jumped);
  EXPECT_EQ(counter.update(Timestamp{1s} + 30ms, 0), Step::jumped);
  EXPECT_EQ(counter.ticks(), 600);
  EXPECT_EQ(counter.update(Timestamp{1s} + 40ms, -100), Step::moved);
  EXPECT_EQ(counter.ticks(), 500);
}

TEST(WheelCounter, GivenASilenceInWhichTheEncoderCanHaveWrappedThenTheStepIsNotBelieved) {
  // 4096 counts at most 1000 a second: half a turn takes 2.048 s
  WheelCounter counter{WheelCounterConfig{.modulus = 4096, .max_counts_per_s = 1000}};
  static_cast<void>(counter.update(Timestamp{1s}, 0));
  EXPECT_EQ(counter.update(Timestamp{3s}, 1000), Step::moved);
  EXPECT_EQ(counter.update(Timestamp{3s} + 2048ms, 2000), Step::rebased);
  EXPECT_EQ(counter.ticks(), 1000);
}

TEST(WheelCounter, GivenNoSpeedLimitThenOnlyASmallModulusMakesALongSilenceAmbiguous) {
  WheelCounter small{WheelCounterConfig{.modulus = 4096, .max_silence = 500ms}};
  WheelCounter large{WheelCounterConfig{.max_silence = 500ms}};
  for (WheelCounter* counter : {&small, &large}) {
    static_cast<void>(counter->update(Timestamp{1s}, 0));
  }
  EXPECT_EQ(small.update(Timestamp{1s} + 500ms, 10), Step::moved);
  EXPECT_EQ(small.update(Timestamp{1s} + 1001ms, 20), Step::rebased);
  EXPECT_EQ(large.update(Timestamp{100s}, 20), Step::moved);
}

TEST(WheelCounter, GivenStampsThatRunBackOrLieDaysApartThenNothingOverflows) {
  WheelCounter counter{WheelCounterConfig{.max_counts_per_s = UINT32_MAX}};
  static_cast<void>(counter.update(Timestamp{1000s}, 0));
  EXPECT_EQ(counter.update(Timestamp{1s}, 10), Step::moved);
  EXPECT_EQ(counter.update(Timestamp{1'000'000'000s}, 20), Step::rebased);
}

}  // namespace
}  // namespace picolo::test
