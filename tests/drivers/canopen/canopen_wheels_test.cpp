// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/canopen_wheels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "drives.hpp"
#include "support/fake_can_bus.hpp"

namespace picolo::test {
namespace {

using canopen::NodeState;

Timestamp at_ms(std::int64_t ms) {
  return Timestamp{Duration{ms * 1000}};
}

class TwoDrives : public testing::Test {
 protected:
  /// One SYNC and both answers, the right one 250 us after the left one.
  void sync_and_answers(std::int64_t ms, std::int64_t left, std::int64_t right) {
    bus_.arrives(sync_at(at_ms(ms)));
    bus_.arrives(tpdo(at_ms(ms) + 300us, 0x181, left));
    bus_.arrives(tpdo(at_ms(ms) + 550us, 0x182, right));
  }
  FakeCanBus bus_;
  CanopenWheels wheels_{bus_, two_cia402_drives(1, 2)};
};

TEST_F(TwoDrives, GivenSyncedPositionsThenSamplesCarryTheSyncStampAndCumulativeCounts) {
  sync_and_answers(10, 1000, -500);
  sync_and_answers(20, 1010, -520);
  const auto first = wheels_.poll(10);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->restarted);
  EXPECT_EQ(first->stamp, at_ms(10));
  const auto second = wheels_.poll(10);
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->restarted);
  EXPECT_EQ(second->stamp, at_ms(20));
  EXPECT_EQ(second->ticks[0] - first->ticks[0], 10);
  EXPECT_EQ(second->ticks[1] - first->ticks[1], -20);
  EXPECT_EQ(wheels_.poll(10).status(), Status::not_ready);
  EXPECT_EQ(wheels_.counters().samples, 2U);
  EXPECT_EQ(wheels_.counters().syncs_seen, 2U);
  EXPECT_EQ(wheels_.counters().process_data, 4U);
}

TEST_F(TwoDrives, GivenMoreFramesThanTheBudgetThenPollTakesNoMoreThanTheBudget) {
  for (int i = 0; i < 20; ++i) { bus_.arrives(can_frame(at_ms(i), 0x555)); }
  EXPECT_EQ(wheels_.poll(4).status(), Status::not_ready);
  EXPECT_EQ(bus_.waiting(), 16U);
  EXPECT_EQ(wheels_.counters().foreign, 4U);
  EXPECT_EQ(wheels_.poll(0).status(), Status::not_ready);
  EXPECT_EQ(bus_.waiting(), 16U);
}

TEST_F(TwoDrives, GivenACompleteSampleThenPollStopsThere) {
  sync_and_answers(10, 0, 0);
  sync_and_answers(20, 1, 1);
  EXPECT_TRUE(wheels_.poll(100));
  EXPECT_EQ(bus_.waiting(), 3U);
}

TEST_F(TwoDrives, GivenABusThatIsGoneThenPollAndServiceSaySo) {
  bus_.disconnect();
  EXPECT_EQ(wheels_.poll(4).status(), Status::disconnected);
  wheels_.request_start();
  EXPECT_EQ(wheels_.service(at_ms(1)), Status::disconnected);
  EXPECT_EQ(wheels_.counters().tx_refused, 2U);
  bus_.reconnect();
  EXPECT_EQ(wheels_.service(at_ms(2)), Status::ok);
  EXPECT_EQ(bus_.sent().size(), 2U) << "the refused starts are tried again";
}

TEST_F(TwoDrives, GivenSomebodyElsesFramesThenConsumeLeavesThemToOthers) {
  CanFrame extended = tpdo(at_ms(1), 0x181, 5);
  extended.extended = true;
  CanFrame remote = can_frame(at_ms(1), 0x181);
  remote.remote = true;
  for (const CanFrame& frame : {extended, remote, can_frame(at_ms(1), 0x183, {1, 2, 3, 4}),
                                can_frame(at_ms(1), 0x000, {1, 1}), can_frame(at_ms(1), 0x703, {5}),
                                can_frame(at_ms(1), 0x083, {0, 0, 0})}) {
    EXPECT_FALSE(wheels_.consume(frame)) << std::hex << frame.id;
  }
  EXPECT_EQ(wheels_.counters().foreign, 6U);
  EXPECT_TRUE(wheels_.consume(tpdo(at_ms(1), 0x181, 5)));
  EXPECT_TRUE(wheels_.consume(sync_at(at_ms(1))));
  EXPECT_TRUE(wheels_.consume(heartbeat(at_ms(1), 2, kOperational)));
  EXPECT_TRUE(wheels_.consume(can_frame(at_ms(1), 0x081, {0x10, 0x81, 0x11})));
  EXPECT_EQ(wheels_.counters().foreign, 6U);
}

TEST_F(TwoDrives, GivenAPdoShorterThanItsMappingThenItIsIgnoredAndCounted) {
  bus_.arrives(sync_at(at_ms(10)));
  bus_.arrives(can_frame(at_ms(10), 0x181, {1, 2, 3}));
  bus_.arrives(tpdo(at_ms(11), 0x182, 4));
  EXPECT_EQ(wheels_.poll(10).status(), Status::not_ready);
  EXPECT_EQ(wheels_.counters().short_frames, 1U);
  EXPECT_EQ(wheels_.counters().process_data, 1U);
  EXPECT_EQ(wheels_.node(0).state, NodeState::silent);
}

TEST_F(TwoDrives, GivenAPdoLongerThanItsMappingThenItsBeginningCounts) {
  sync_and_answers(10, 100, 100);
  ASSERT_TRUE(wheels_.poll(10));
  bus_.arrives(tpdo(at_ms(20), 0x181, 107, 0x12345678));
  bus_.arrives(tpdo(at_ms(20), 0x182, 109));
  const auto sample = wheels_.poll(10);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->ticks[0], 7);
  EXPECT_EQ(sample->ticks[1], 9);
}

TEST_F(TwoDrives, GivenABootUpThenTheJumpIsDroppedTheSampleSaysSoAndTheNodeIsStarted) {
  sync_and_answers(10, 70'000, 80'000);
  sync_and_answers(20, 70'100, 80'100);
  ASSERT_TRUE(wheels_.poll(10));
  ASSERT_TRUE(wheels_.poll(10));
  bus_.arrives(heartbeat(at_ms(25), 1, kBootUp));
  sync_and_answers(30, 0, 80'200);
  const auto restarted = wheels_.poll(10);
  ASSERT_TRUE(restarted);
  EXPECT_TRUE(restarted->restarted);
  EXPECT_EQ(restarted->ticks[0], 100);
  EXPECT_EQ(restarted->ticks[1], 200);
  sync_and_answers(40, 40, 80'300);
  const auto next = wheels_.poll(10);
  ASSERT_TRUE(next);
  EXPECT_FALSE(next->restarted);
  EXPECT_EQ(next->ticks[0], 140);
  EXPECT_EQ(wheels_.node(0).boots, 1U);
  EXPECT_EQ(wheels_.node(1).boots, 0U);
}

TEST_F(TwoDrives, GivenABootUpBetweenTheTwoAnswersThenTheOldCountMakesNoPair) {
  sync_and_answers(10, 5, 5);
  ASSERT_TRUE(wheels_.poll(10));
  bus_.arrives(sync_at(at_ms(20)));
  bus_.arrives(tpdo(at_ms(20) + 300us, 0x181, 6));
  bus_.arrives(heartbeat(at_ms(20) + 400us, 1, kBootUp));
  bus_.arrives(tpdo(at_ms(20) + 550us, 0x182, 6));
  EXPECT_EQ(wheels_.poll(10).status(), Status::not_ready);
  EXPECT_EQ(wheels_.counters().unpaired, 1U);
}

TEST_F(TwoDrives, GivenSamplesThatNobodyTakesThenTheNewestStaysAndARestartIsNotForgotten) {
  for (int k = 1; k <= 3; ++k) {
    ASSERT_TRUE(wheels_.consume(sync_at(at_ms(10 * k))));
    ASSERT_TRUE(wheels_.consume(tpdo(at_ms(10 * k), 0x181, k)));
    ASSERT_TRUE(wheels_.consume(tpdo(at_ms(10 * k), 0x182, k)));
  }
  const auto sample = wheels_.take();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, at_ms(30));
  EXPECT_TRUE(sample->restarted);
  EXPECT_EQ(wheels_.counters().replaced, 2U);
  EXPECT_EQ(wheels_.take().status(), Status::not_ready);
}

TEST_F(TwoDrives, GivenHeartbeatLossAndRecoveryThenHealthFollowsAndCountingGoesOn) {
  for (std::uint8_t node : {std::uint8_t{1}, std::uint8_t{2}}) {
    ASSERT_TRUE(wheels_.consume(heartbeat(at_ms(0), node, kOperational)));
  }
  EXPECT_TRUE(wheels_.healthy());
  sync_and_answers(10, 0, 0);
  ASSERT_TRUE(wheels_.poll(10));
  ASSERT_TRUE(wheels_.consume(heartbeat(at_ms(400), 1, kOperational)));
  EXPECT_EQ(wheels_.service(at_ms(600)), Status::ok);
  EXPECT_EQ(wheels_.node(0).state, NodeState::operational);
  EXPECT_EQ(wheels_.node(1).state, NodeState::lost);
  EXPECT_FALSE(wheels_.healthy());
  ASSERT_TRUE(wheels_.consume(heartbeat(at_ms(700), 2, kOperational)));
  EXPECT_TRUE(wheels_.healthy());
  EXPECT_EQ(wheels_.node(1).losses, 1U);
  EXPECT_EQ(wheels_.node(1).recoveries, 1U);
  sync_and_answers(710, 50, 60);
  const auto sample = wheels_.poll(10);
  ASSERT_TRUE(sample);
  EXPECT_FALSE(sample->restarted)
      << "the node never restarted: its 32-bit count tells how far the wheel went";
  EXPECT_EQ(sample->ticks[1], 60);
}

TEST_F(TwoDrives, GivenPreOperationalNodesThenTheyAreStartedAndAFullQueueOnlyDelays) {
  ASSERT_TRUE(wheels_.consume(heartbeat(at_ms(0), 1, kPreOperational)));
  bus_.send_queue_is_full(true);
  EXPECT_EQ(wheels_.service(at_ms(1)), Status::full);
  EXPECT_EQ(wheels_.node(0).starts_sent, 0U);
  bus_.send_queue_is_full(false);
  EXPECT_EQ(wheels_.service(at_ms(2)), Status::ok);
  const auto sent = bus_.take_sent();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].id, 0U);
  EXPECT_EQ(sent[0].data[0], 0x01);
  EXPECT_EQ(sent[0].data[1], 0x01);
  EXPECT_EQ(wheels_.service(at_ms(3)), Status::ok);
  EXPECT_TRUE(bus_.sent().empty());
}

TEST_F(TwoDrives, GivenBadHeartbeatsAndEmergenciesThenTheyAreCountedAndChangeNothing) {
  ASSERT_TRUE(wheels_.consume(can_frame(at_ms(1), 0x701)));
  ASSERT_TRUE(wheels_.consume(can_frame(at_ms(1), 0x701, {0x42})));
  ASSERT_TRUE(wheels_.consume(can_frame(at_ms(1), 0x081, {0x10, 0x81})));
  EXPECT_EQ(wheels_.counters().short_frames, 2U);
  EXPECT_EQ(wheels_.counters().bad_states, 1U);
  EXPECT_EQ(wheels_.node(0).state, NodeState::silent);
  ASSERT_TRUE(wheels_.consume(can_frame(at_ms(1), 0x082, {0x30, 0x81, 0x11})));
  EXPECT_EQ(wheels_.node(1).emergency_code, 0x8130);
  EXPECT_EQ(wheels_.node(1).emergencies, 1U);
}

TEST_F(TwoDrives, GivenTheFiltersThenTheyPassExactlyWhatConsumeTakes) {
  const auto filters = wheels_.filters();
  EXPECT_EQ(filters.size(), 7U);
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    bool passes = false;
    for (const CanFilter& filter : filters) { passes = passes || filter.accepts(id, false); }
    EXPECT_EQ(wheels_.consume(can_frame(at_ms(1), id)), passes) << std::hex << id;
  }
}

TEST_F(TwoDrives, GivenAFrameThatClaimsMoreThanEightBytesThenItIsNotTouched) {
  CanFrame frame = tpdo(at_ms(1), 0x181, 5);
  frame.length = 9;
  EXPECT_FALSE(wheels_.consume(frame));
}

TEST_F(TwoDrives, GivenARestartBehindASampleThatNobodyTookThenItIsToldToo) {
  sync_and_answers(10, 5, 5);
  ASSERT_TRUE(wheels_.poll(10));
  for (const CanFrame& frame :
       {tpdo(at_ms(20), 0x181, 6), tpdo(at_ms(20), 0x182, 6), heartbeat(at_ms(25), 2, kBootUp),
        tpdo(at_ms(30), 0x181, 7), tpdo(at_ms(30), 0x182, 0)}) {
    ASSERT_TRUE(wheels_.consume(frame));
  }
  const auto sample = wheels_.take();
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->restarted);
  EXPECT_EQ(sample->ticks[0], 2);
  EXPECT_EQ(sample->ticks[1], 1);
}

class SyncProducer : public testing::Test {
 protected:
  static CanopenWheelsConfig config(std::uint8_t overflow = 0) {
    CanopenWheelsConfig config = two_cia402_drives(1, 2);
    config.produce_sync = true;
    config.sync_counter_overflow = overflow;
    return config;
  }
  FakeCanBus bus_;
};

TEST_F(SyncProducer, GivenACycleOfFiveMillisecondsThenSyncGoesOutEveryTenWithoutDrift) {
  CanopenWheels wheels{bus_, config()};
  for (int ms = 100; ms < 1100; ms += 5) { EXPECT_EQ(wheels.service(at_ms(ms)), Status::ok); }
  EXPECT_EQ(bus_.sent().size(), 100U);
  EXPECT_THAT(bus_.sent(), testing::Each(testing::Field(&CanFrame::id, 0x80U)));
  EXPECT_EQ(wheels.counters().syncs_sent, 100U);
  EXPECT_EQ(wheels.counters().syncs_skipped, 0U);
}

TEST_F(SyncProducer, GivenAnUnsteadyCycleThenThePeriodHoldsOnAverage) {
  CanopenWheels wheels{bus_, config()};
  for (int ms = 0; ms < 10'000; ms += 7) { EXPECT_EQ(wheels.service(at_ms(ms)), Status::ok); }
  EXPECT_EQ(bus_.sent().size(), 1000U);
}

TEST_F(SyncProducer, GivenALateCallThenMissedPeriodsAreCountedAndNotMadeUp) {
  CanopenWheels wheels{bus_, config()};
  EXPECT_EQ(wheels.service(at_ms(0)), Status::ok);
  EXPECT_EQ(wheels.service(at_ms(45)), Status::ok);
  EXPECT_EQ(wheels.service(at_ms(46)), Status::ok);
  EXPECT_EQ(bus_.sent().size(), 2U);
  EXPECT_EQ(wheels.counters().syncs_skipped, 3U);
  EXPECT_EQ(wheels.service(at_ms(50)), Status::ok);
  EXPECT_EQ(bus_.sent().size(), 3U);
}

TEST_F(SyncProducer, GivenACounterThenItRunsFromOneToItsOverflow) {
  CanopenWheels wheels{bus_, config(3)};
  for (int ms = 0; ms < 50; ms += 10) { EXPECT_EQ(wheels.service(at_ms(ms)), Status::ok); }
  std::vector<int> counters;
  for (const CanFrame& frame : bus_.sent()) {
    ASSERT_EQ(frame.length, 1);
    counters.push_back(frame.data[0]);
  }
  EXPECT_THAT(counters, testing::ElementsAre(1, 2, 3, 1, 2));
}

TEST_F(SyncProducer, GivenARefusedSyncThenNoEpochOpensAndItIsTriedAgain) {
  CanopenWheels wheels{bus_, config()};
  bus_.send_queue_is_full(true);
  EXPECT_EQ(wheels.service(at_ms(10)), Status::full);
  bus_.send_queue_is_full(false);
  EXPECT_EQ(wheels.service(at_ms(15)), Status::ok);
  bus_.arrives(tpdo(at_ms(15) + 300us, 0x181, 1));
  bus_.arrives(tpdo(at_ms(15) + 500us, 0x182, 1));
  EXPECT_EQ(wheels.poll(4)->stamp, at_ms(15));
}

TEST_F(SyncProducer, GivenAnswersDrainedAfterTheNextSyncThenTheyKeepTheStampOfTheirOwn) {
  CanopenWheels wheels{bus_, config()};
  EXPECT_EQ(wheels.service(at_ms(10)), Status::ok);
  bus_.arrives(tpdo(at_ms(10) + 300us, 0x181, 1));
  bus_.arrives(tpdo(at_ms(10) + 550us, 0x182, 1));
  EXPECT_EQ(wheels.service(at_ms(20)), Status::ok);
  bus_.arrives(tpdo(at_ms(20) + 300us, 0x181, 2));
  bus_.arrives(tpdo(at_ms(20) + 550us, 0x182, 2));
  EXPECT_EQ(wheels.poll(10)->stamp, at_ms(10));
  EXPECT_EQ(wheels.poll(10)->stamp, at_ms(20));
}

TEST_F(SyncProducer, GivenASecondProducerThenItIsCountedAndDoesNotOpenEpochs) {
  CanopenWheels wheels{bus_, config()};
  EXPECT_EQ(wheels.service(at_ms(10)), Status::ok);
  EXPECT_TRUE(wheels.consume(sync_at(at_ms(11))));
  EXPECT_EQ(wheels.counters().sync_conflicts, 1U);
  EXPECT_TRUE(wheels.consume(tpdo(at_ms(12), 0x181, 1)));
  EXPECT_TRUE(wheels.consume(tpdo(at_ms(12), 0x182, 1)));
  EXPECT_EQ(wheels.take()->stamp, at_ms(10));
}

}  // namespace
}  // namespace picolo::test
