// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/sync_pairing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "picolo/core/random.hpp"
#include "support/property.hpp"

namespace picolo::test {
namespace {

using canopen::SyncPairing;
using canopen::SyncPairingConfig;

static_assert(SyncPairingConfig{}.valid());
static_assert(!SyncPairingConfig{.wheel_count = 5}.valid());

constexpr std::size_t kLeft = 0;
constexpr std::size_t kRight = 1;

Timestamp at(std::int64_t us) {
  return Timestamp{Duration{us}};
}

class Pairing : public testing::Test {
 protected:
  Result<WheelTicks> count(std::size_t wheel, std::int64_t us, std::int64_t ticks,
                           bool restarted = false) {
    return pairing_.count(wheel, at(us), StampSource::kernel, ticks, restarted);
  }
  void sync(std::int64_t us) { pairing_.sync(at(us), StampSource::hardware); }
  SyncPairing pairing_{SyncPairingConfig{}};
};

TEST_F(Pairing, GivenASyncThenThePairCarriesItsStampInEitherOrder) {
  sync(10'000);
  EXPECT_EQ(count(kLeft, 10'300, 5).status(), Status::not_ready);
  auto sample = count(kRight, 10'550, 6);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, at(10'000));
  EXPECT_EQ(sample->source, StampSource::hardware);
  EXPECT_EQ(sample->ticks[0], 5);
  EXPECT_EQ(sample->ticks[1], 6);
  EXPECT_FALSE(sample->restarted);
  sync(20'000);
  EXPECT_FALSE(count(kRight, 20'300, 7));
  EXPECT_EQ(count(kLeft, 20'550, 8)->stamp, at(20'000));
  EXPECT_EQ(pairing_.unpaired(), 0U);
}

TEST_F(Pairing, GivenNoSyncThenThePairCarriesTheEarlierStamp) {
  EXPECT_FALSE(count(kRight, 10'550, 1));
  const auto sample = count(kLeft, 10'300, 2);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, at(10'300));
  EXPECT_EQ(sample->source, StampSource::kernel);
}

TEST_F(Pairing, GivenALostCountThenItsPartnerIsNotPairedWithTheNextEpoch) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1));  // right lost
  sync(20'000);
  EXPECT_FALSE(count(kRight, 20'300, 2));
  const auto sample = count(kLeft, 20'500, 3);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, at(20'000));
  EXPECT_EQ(sample->ticks[0], 3);
  sync(30'000);
  sync(40'000);
  EXPECT_EQ(pairing_.unpaired(), 1U);
}

TEST_F(Pairing, GivenNoSyncAndALostCountThenPairsDoNotStayCrossed) {
  EXPECT_FALSE(count(kLeft, 10'000, 1));
  EXPECT_TRUE(count(kRight, 10'250, 1));
  EXPECT_FALSE(count(kRight, 20'250, 2));  // left lost
  EXPECT_FALSE(count(kLeft, 30'000, 3));   // too late for the right one
  const auto sample = count(kRight, 30'250, 3);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->ticks[0], sample->ticks[1]);
  EXPECT_EQ(pairing_.unpaired(), 1U);
}

TEST_F(Pairing, GivenALostSyncThenTheNextPairCarriesItsOwnStamp) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1));
  EXPECT_TRUE(count(kRight, 10'550, 1));
  EXPECT_FALSE(count(kLeft, 20'300, 2));  // the SYNC at 20 ms did not reach us
  EXPECT_EQ(count(kRight, 20'550, 2)->stamp, at(20'300));
}

TEST_F(Pairing, GivenALostSyncAndALostCountThenTheOldSyncIsNotUsed) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1));  // right lost, then the SYNC at 20 ms too
  EXPECT_FALSE(count(kLeft, 20'300, 2));
  const auto sample = count(kRight, 20'550, 2);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, at(20'300));
  EXPECT_EQ(sample->ticks[0], 2);
}

TEST_F(Pairing, GivenFramesThatStillWaitedWhenWeSentTheNextSyncThenTheyKeepTheirEpoch) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1));
  sync(20'000);                                 // produced before the queue was drained
  const auto first = count(kRight, 10'550, 1);  // older than the SYNC
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, at(10'000));
  EXPECT_FALSE(count(kLeft, 20'300, 2));
  EXPECT_EQ(count(kRight, 20'550, 2)->stamp, at(20'000));
  EXPECT_EQ(pairing_.unpaired(), 0U);
}

TEST_F(Pairing, GivenBothFramesWaitingWhenTheNextSyncWentOutThenTheyKeepTheirEpoch) {
  sync(10'000);
  sync(20'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1));
  EXPECT_EQ(count(kRight, 10'550, 1)->stamp, at(10'000));
}

TEST_F(Pairing, GivenAStampJustBeforeTheSyncAndNoEpochBeforeItThenTheCountBelongsToTheSync) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 9'950, 1));  // a clock that is not that good
  EXPECT_EQ(count(kRight, 10'100, 1)->stamp, at(10'000));
}

TEST_F(Pairing, GivenASyncLongAgoThenItIsNotTheStampOfALateEvent) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 3'000'000, 1));
  EXPECT_EQ(count(kRight, 3'000'200, 1)->stamp, at(3'000'000));
}

TEST_F(Pairing, GivenEverySecondSyncAnsweredThenNothingIsCountedAsUnpaired) {
  for (int k = 0; k < 10; ++k) {
    sync(k * 10'000);
    if (k % 2 != 0) { continue; }
    EXPECT_FALSE(count(kLeft, k * 10'000 + 300, k));
    EXPECT_TRUE(count(kRight, k * 10'000 + 500, k));
  }
  EXPECT_EQ(pairing_.unpaired(), 0U);
}

TEST_F(Pairing, GivenARestartInALostPairThenTheNextSampleStillTells) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1, true));  // right lost
  sync(20'000);
  EXPECT_FALSE(count(kLeft, 20'300, 2));
  EXPECT_TRUE(count(kRight, 20'500, 2)->restarted);
  sync(30'000);
  EXPECT_FALSE(count(kLeft, 30'300, 3));
  EXPECT_FALSE(count(kRight, 30'500, 3)->restarted);
}

TEST_F(Pairing, GivenAForgottenWheelThenItsOldCountMakesNoPair) {
  sync(10'000);
  EXPECT_FALSE(count(kLeft, 10'300, 1));
  pairing_.forget(kLeft);
  pairing_.forget(kRight);
  EXPECT_FALSE(count(kRight, 10'550, 1));
  EXPECT_EQ(count(kLeft, 10'700, 9, true)->ticks[0], 9);
  EXPECT_EQ(pairing_.unpaired(), 1U);
}

TEST_F(Pairing, GivenOneWheelThenEveryCountIsASample) {
  SyncPairing single{SyncPairingConfig{.wheel_count = 1}};
  EXPECT_EQ(single.count(0, at(100), StampSource::read, 4, false)->ticks[0], 4);
  EXPECT_EQ(single.count(0, at(50), StampSource::read, 5, false)->stamp, at(100))
      << "stamps never decrease";
}

TEST_F(Pairing, GivenFourWheelsThenAllFourMakeASample) {
  SyncPairing four{SyncPairingConfig{.wheel_count = 4}};
  four.sync(at(1000), StampSource::read);
  for (std::size_t wheel : {2U, 0U, 3U}) {
    EXPECT_FALSE(
        four.count(wheel, at(1200), StampSource::read, static_cast<std::int64_t>(wheel), false));
  }
  const auto sample = four.count(1, at(1300), StampSource::read, 1, false);
  ASSERT_TRUE(sample);
  for (std::size_t wheel = 0; wheel < 4; ++wheel) {
    EXPECT_EQ(sample->ticks.at(wheel), static_cast<std::int64_t>(wheel));
  }
}

/// A bus with jitter: each wheel answers each SYNC after its own delay, some answers and some SYNCs
/// are lost.
TEST_F(Pairing, PropertyNoSampleMixesEpochsWhateverIsDelayedOrLost) {
  EXPECT_TRUE(rc::check([] {
    Random random{*rc::gen::arbitrary<std::uint64_t>()};
    const auto loss_percent = *rc::gen::inRange<std::uint32_t>(0, 40);
    struct Event {
      std::int64_t us;
      int what;  // 0 left, 1 right, 2 SYNC
      std::int64_t epoch;
    };
    std::vector<Event> events;
    for (std::int64_t epoch = 1; epoch <= 100; ++epoch) {
      const std::int64_t start = epoch * 10'000;
      for (int what = 0; what < 3; ++what) {
        const std::int64_t delay = what == 2 ? 0 : 1 + random.below(1900);
        if (random.below(100) >= loss_percent) { events.push_back({start + delay, what, epoch}); }
      }
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& a, const Event& b) { return a.us < b.us; });
    SyncPairing pairing{SyncPairingConfig{}};
    std::int64_t complete = 0;
    std::int64_t last_epoch = 0;
    std::int64_t counts = 0;
    for (const Event& event : events) {
      if (event.what == 2) {
        pairing.sync(at(event.us), StampSource::read);
        continue;
      }
      ++counts;
      const auto sample = pairing.count(static_cast<std::size_t>(event.what), at(event.us),
                                        StampSource::read, event.epoch, false);
      if (!sample) { continue; }
      ++complete;
      RC_ASSERT(sample->ticks[0] == sample->ticks[1]);
      RC_ASSERT(sample->ticks[0] > last_epoch);
      last_epoch = sample->ticks[0];
      const Duration late = sample->stamp - at(sample->ticks[0] * 10'000);
      RC_ASSERT(late >= Duration{0} && late < 2ms);
    }
    pairing.sync(at(2'000'000), StampSource::read);
    pairing.sync(at(2'010'000), StampSource::read);
    RC_ASSERT(2 * complete + pairing.unpaired() == counts);
    if (loss_percent == 0) { RC_ASSERT(complete == 100); }
  }));
}

}  // namespace
}  // namespace picolo::test
