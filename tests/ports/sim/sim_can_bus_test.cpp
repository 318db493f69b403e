// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The two ends of the simulated bus: order, time on the wire, queues, fault confinement.

#include "picolo/sim/sim_can_bus.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "picolo/sim/sim_clock.hpp"

namespace picolo::sim {
namespace {

struct Recorder final : CanListener {
  void heard(const CanFrame& frame, bool from_firmware) override {
    frames.push_back(frame);
    directions.push_back(from_firmware);
  }
  std::vector<CanFrame> frames;
  std::vector<bool> directions;
};

class SimCanBusTest : public ::testing::Test {
 protected:
  SimClock clock{Timestamp{1s}};
  SimCanBus bus{clock, 500'000};
};

TEST_F(SimCanBusTest, GivenEightBytesThenTheFrameTakes222MicrosecondsAt500Kilobit) {
  EXPECT_EQ(frame_time({.length = 8}, 500'000), 222us);
  EXPECT_EQ(frame_time({.length = 0}, 500'000), 94us);
  EXPECT_EQ(frame_time({.extended = true, .length = 8}, 500'000), 262us);
  EXPECT_EQ(frame_time({.remote = true, .length = 8}, 500'000), 94us);
}

TEST_F(SimCanBusTest, GivenAFrameUnderWayThenItArrivesWithItsLastBit) {
  const Timestamp end = bus.deliver({.stamp = clock.now(), .id = 0x181, .length = 8});
  EXPECT_EQ(end, Timestamp{1s} + 222us);
  clock.set(end - 1us);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  clock.set(end);
  const auto frame = bus.receive();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x181U);
  EXPECT_EQ(frame->stamp, end);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  EXPECT_EQ(bus.status().received, 1U);
}

TEST_F(SimCanBusTest, GivenTwoNodesAtOneInstantThenTheFramesFollowEachOther) {
  const Timestamp first = bus.deliver({.stamp = clock.now(), .id = 0x181, .length = 8});
  const Timestamp second = bus.deliver({.stamp = clock.now(), .id = 0x182, .length = 8});
  EXPECT_EQ(second - first, 222us);
}

TEST_F(SimCanBusTest, WhenTheFirmwareSendsThenTheVehicleTakesItAfterItsTimeOnTheWire) {
  ASSERT_EQ(bus.transmit({.id = 0x080}), Status::ok);
  EXPECT_EQ(bus.take_sent(clock.now() + 93us).status(), Status::not_ready);
  const auto sent = bus.take_sent(clock.now() + 94us);
  ASSERT_TRUE(sent);
  EXPECT_EQ(sent->id, 0x080U);
  EXPECT_EQ(sent->stamp, clock.now() + 94us);
}

TEST_F(SimCanBusTest, GivenAnImpossibleFrameThenTransmitRefusesIt) {
  EXPECT_EQ(bus.transmit({.id = 0x800}), Status::invalid_argument);
  EXPECT_EQ(bus.transmit({.id = 1, .length = 9}), Status::invalid_argument);
  EXPECT_EQ(bus.transmit({.id = 0x2000'0000, .extended = true}), Status::invalid_argument);
  EXPECT_EQ(bus.transmit({.id = 0x1FFF'FFFF, .extended = true}), Status::ok);
  EXPECT_EQ(bus.status().transmitted, 1U);
}

TEST_F(SimCanBusTest, GivenAFullSendQueueThenTransmitSaysFullAndCounts) {
  for (std::size_t i = 0; i < SimCanBus::kTransmitCapacity; ++i) {
    ASSERT_EQ(bus.transmit({.id = 1}), Status::ok);
  }
  EXPECT_EQ(bus.transmit({.id = 1}), Status::full);
  EXPECT_EQ(bus.status().tx_refused, 1U);
}

TEST_F(SimCanBusTest, GivenAnUndrainedQueueThenTheNewestFramesAreLostAndCounted) {
  for (std::uint32_t i = 0; i < SimCanBus::kReceiveCapacity + 3; ++i) {
    bus.deliver({.stamp = clock.now(), .id = i});
  }
  EXPECT_EQ(bus.status().rx_lost, 3U);
  clock.advance(1s);
  EXPECT_EQ(bus.receive()->id, 0U);
}

TEST_F(SimCanBusTest, GivenBusOffThenNothingPassesUntilTheRestartWhichIsCounted) {
  bus.set_state(CanState::bus_off);
  EXPECT_EQ(bus.transmit({.id = 1}), Status::full);
  bus.deliver({.stamp = clock.now(), .id = 2});
  bus.set_state(CanState::active);
  clock.advance(1s);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  EXPECT_EQ(bus.status().restarts, 1U);
  EXPECT_EQ(bus.transmit({.id = 1}), Status::ok);
}

TEST_F(SimCanBusTest, GivenAnAbsentControllerThenEveryCallSaysDisconnectedAndItComesBack) {
  bus.set_state(CanState::absent);
  EXPECT_EQ(bus.receive().status(), Status::disconnected);
  EXPECT_EQ(bus.transmit({.id = 1}), Status::disconnected);
  bus.set_state(CanState::active);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
}

TEST_F(SimCanBusTest, GivenAListenerThenItHearsBothDirections) {
  Recorder recorder;
  bus.attach(&recorder);
  ASSERT_EQ(bus.transmit({.id = 0x080}), Status::ok);
  bus.deliver({.stamp = clock.now(), .id = 0x181, .length = 8});
  ASSERT_EQ(recorder.frames.size(), 2U);
  EXPECT_TRUE(recorder.directions[0]);
  EXPECT_FALSE(recorder.directions[1]);
  EXPECT_EQ(recorder.frames[1].stamp - recorder.frames[0].stamp, 222us);
}

}  // namespace
}  // namespace picolo::sim
