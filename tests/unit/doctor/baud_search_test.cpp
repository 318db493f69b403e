// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "live/baud_search.hpp"

namespace picolo::tool {
namespace {

devices::Counters counters(std::uint64_t frames, std::uint64_t bad = 0) {
  return {{"frames", frames}, {"bad_checksums", bad}};
}

TEST(BaudSearch, GivenNothingSoundThenTheNextRateIsTriedEveryTwoSecondsRoundAndRound) {
  BaudSearch search{{100, 200, 300}};
  std::vector<std::uint32_t> tried;
  for (Timestamp now{5s}; now <= Timestamp{13s}; now += 100ms) {
    if (const auto next = search.update(now, true, counters(0))) { tried.push_back(*next); }
  }
  EXPECT_EQ(tried, (std::vector<std::uint32_t>{200, 300, 100, 200}));
}

TEST(BaudSearch, GivenSoundPacketsThenTheRateStaysForGood) {
  BaudSearch search{{100, 200}};
  EXPECT_FALSE(search.update(Timestamp{0s}, true, counters(0)));
  EXPECT_EQ(search.update(Timestamp{2s}, true, counters(1, 4)), 200U);
  EXPECT_FALSE(search.update(Timestamp{3s}, true, counters(4, 5)));
  EXPECT_TRUE(search.found_another());
  EXPECT_FALSE(search.found_another()) << "told once";
  EXPECT_FALSE(search.update(Timestamp{60s}, true, counters(4, 5)))
      << "silence later is another matter";
}

TEST(BaudSearch, GivenMoreDamagedThanSoundPacketsThenTheRateIsNotBelieved) {
  BaudSearch search{{100, 200}};
  EXPECT_FALSE(search.update(Timestamp{0s}, true, counters(0)));
  EXPECT_FALSE(search.update(Timestamp{1s}, true, counters(5, 50)));
  EXPECT_EQ(search.update(Timestamp{2s}, true, counters(6, 99)), 200U);
}

TEST(BaudSearch, GivenASlowDeviceThenItIsWaitedForAslongAsSoundPacketsCome) {
  BaudSearch search{{100, 200}};
  EXPECT_FALSE(search.update(Timestamp{0s}, true, counters(0)));
  EXPECT_FALSE(search.update(Timestamp{1900ms}, true, counters(1)));
  EXPECT_FALSE(search.update(Timestamp{3800ms}, true, counters(2)));
  EXPECT_FALSE(search.update(Timestamp{5700ms}, true, counters(3)));
  EXPECT_FALSE(search.found_another()) << "it had the first rate";
}

TEST(BaudSearch, GivenNoLineOrOneRateThenThereIsNothingToTry) {
  BaudSearch absent{{100, 200}};
  BaudSearch single{{100}};
  for (Timestamp now{0s}; now < Timestamp{10s}; now += 500ms) {
    EXPECT_FALSE(absent.update(now, false, counters(0)));
    EXPECT_FALSE(single.update(now, true, counters(0)));
  }
  EXPECT_FALSE(absent.update(Timestamp{11s}, true, counters(0))) << "its time begins when it comes";
}

}  // namespace
}  // namespace picolo::tool
