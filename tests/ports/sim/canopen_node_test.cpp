// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The nodes as a CANopen master sees them.

#include "picolo/sim/canopen_node.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/wheel_pair.hpp"

namespace picolo::sim {
namespace {

/// Turns by `rate` counts a second.
struct Shaft final : EncoderSource {
  std::int64_t rate = 100'000;
  std::int64_t offset = 0;
  [[nodiscard]] EncoderReading reading_at(Timestamp instant) override {
    const std::int64_t elapsed_us = (instant - Timestamp{}).count();
    return {.counts = offset + elapsed_us * rate / 1'000'000, .counts_per_s = rate};
  }
};

class Network {
 public:
  explicit Network(const WheelPairConfig& config = WheelPairConfig{})
      : Network(config, FaultList{}) {}
  Network(const WheelPairConfig& config, const FaultList& faults)
      : faults_(1, faults), wheels_(config, left, right, bus, faults_, Timestamp{}) {}

  /// Lives in steps of 1 ms and returns what the master received.
  std::vector<CanFrame> live(Duration duration) {
    std::vector<CanFrame> frames;
    for (Duration t{}; t < duration; t += 1ms) {
      clock.advance(1ms);
      wheels_.advance_to(clock.now());
      for (auto frame = bus.receive(); frame; frame = bus.receive()) { frames.push_back(*frame); }
    }
    return frames;
  }
  void command(std::uint8_t what, std::uint8_t node) {
    EXPECT_EQ(bus.transmit({.id = 0, .length = 2, .data = {what, node}}), Status::ok);
  }
  std::vector<CanFrame> sync() {
    EXPECT_EQ(bus.transmit({.id = 0x080}), Status::ok);
    return live(2ms);
  }

  SimClock clock;
  SimCanBus bus{clock};
  Shaft left;
  Shaft right;

 private:
  FaultPlan faults_;
  WheelPair wheels_;
};

std::int32_t position(const CanFrame& frame) {
  return load_i32_le(frame.data, 0);
}

TEST(CanopenNode, WhenPoweredUpThenBootUpMessagesAndPreOperationalHeartbeats) {
  Network network;
  const auto frames = network.live(250ms);
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[0].id, 0x701U);
  EXPECT_EQ(frames[1].id, 0x702U);
  EXPECT_EQ(frames[0].length, 1);
  EXPECT_EQ(frames[0].data[0], 0x00);
  EXPECT_GE(frames[0].stamp, Timestamp{30ms});
  EXPECT_LT(frames[0].stamp, Timestamp{31ms});
  EXPECT_EQ(frames[2].data[0], 0x7F);
  EXPECT_NEAR(static_cast<double>((frames[4].stamp - frames[2].stamp).count()), 100'000, 300);
}

TEST(CanopenNode, GivenNoStartThenSyncIsNotAnswered) {
  Network network;
  network.live(50ms);
  EXPECT_TRUE(network.sync().empty());
}

TEST(CanopenNode, GivenAStartBeforeTheBootUpThenItIsNotHeard) {
  Network network;
  network.command(0x01, 0);
  network.live(50ms);
  EXPECT_TRUE(network.sync().empty());
}

TEST(CanopenNode, WhenStartedThenEachSyncIsAnsweredByBothWithThePositionAtItsEnd) {
  Network network;
  network.right.rate = -50'000;
  network.live(50ms);
  network.command(0x01, 0);
  network.live(1ms);
  for (int i = 0; i < 20; ++i) {
    const Timestamp sampled = network.clock.now() + 94us;  // SYNC takes 94 us
    const auto frames = network.sync();
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].id, 0x181U);
    EXPECT_EQ(frames[1].id, 0x182U);
    EXPECT_EQ(frames[1].stamp - frames[0].stamp, 222us);
    ASSERT_EQ(frames[0].length, 8);
    EXPECT_EQ(position(frames[0]), network.left.reading_at(sampled).counts);
    EXPECT_EQ(position(frames[1]), network.right.reading_at(sampled).counts);
    EXPECT_EQ(load_i32_le(frames[0].data, 4), 100'000);
    EXPECT_EQ(load_i32_le(frames[1].data, 4), -50'000);
    network.live(3ms);
  }
}

TEST(CanopenNode, GivenOneNodeAddressedThenOnlyThatOneStarts) {
  Network network;
  network.live(50ms);
  network.command(0x01, 2);
  network.live(1ms);
  const auto frames = network.sync();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].id, 0x182U);
}

TEST(CanopenNode, GivenStopAndPreOperationalThenSilenceOnSyncAndTheStateInTheHeartbeat) {
  Network network;
  network.live(50ms);
  for (const auto [command, state] : {std::array<std::uint8_t, 2>{0x02, 0x04}, {0x80, 0x7F}}) {
    network.command(0x01, 0);
    network.live(1ms);
    EXPECT_EQ(network.sync().size(), 2U);
    network.command(command, 0);
    network.live(1ms);
    EXPECT_TRUE(network.sync().empty());
    const auto heartbeats = network.live(100ms);
    ASSERT_EQ(heartbeats.size(), 2U);
    EXPECT_EQ(heartbeats[0].data[0], state);
  }
}

TEST(CanopenNode, WhenResetThenItBootsAndCountsFromItsInitialPosition) {
  Network network{WheelPairConfig{.left = {.node = 1, .initial_counts = 77}, .right = {.node = 2}}};
  network.live(500ms);
  network.command(0x81, 1);
  bool booted = false;
  for (const CanFrame& frame : network.live(50ms)) {
    booted = booted || (frame.id == 0x701 && frame.data[0] == 0x00);
    EXPECT_FALSE(frame.id == 0x702 && frame.data[0] == 0x00) << "only node 1 was meant";
  }
  EXPECT_TRUE(booted);
  network.command(0x01, 0);
  network.live(1ms);
  const auto pdos = network.sync();
  ASSERT_EQ(pdos.size(), 2U);
  EXPECT_LT(position(pdos[0]), 77 + 100'000 * 0.06);
  EXPECT_GT(position(pdos[0]), 77 + 100'000 * 0.04);
  EXPECT_GT(position(pdos[1]), 50'000);
}

TEST(CanopenNode, WhenOnlyItsCommunicationIsResetThenItBootsAndKeepsItsPosition) {
  Network network;
  network.live(500ms);
  network.command(0x82, 0);
  bool booted = false;
  for (const CanFrame& frame : network.live(50ms)) {
    booted = booted || (frame.id == 0x701 && frame.data[0] == 0x00);
  }
  EXPECT_TRUE(booted);
  network.command(0x01, 0);
  network.command(0x55, 0);  // no command that CiA 301 knows
  network.live(1ms);
  const auto pdos = network.sync();
  ASSERT_EQ(pdos.size(), 2U);
  EXPECT_GT(position(pdos[0]), 50'000);
}

TEST(CanopenNode, GivenEveryThirdSyncThenTwoOfThreeAreSkipped) {
  Network network{WheelPairConfig{.left = {.node = 1, .syncs_per_pdo = 3}, .right = {.node = 2}}};
  network.live(50ms);
  network.command(0x01, 0);
  network.live(1ms);
  std::vector<std::size_t> counts;
  for (int i = 0; i < 6; ++i) { counts.push_back(network.sync().size()); }
  EXPECT_EQ(counts, (std::vector<std::size_t>{1, 1, 2, 1, 1, 2}));
}

TEST(CanopenNode, GivenAModulusThenThePositionWrapsThere) {
  Network network{
      {.left = {.node = 1, .with_velocity = false, .modulus = 10'000, .initial_counts = 9'990},
       .right = {.node = 2, .initial_counts = 0x7FFF'FFF0}}};
  network.left.rate = 0;
  network.right.rate = 0;
  network.live(50ms);
  network.command(0x01, 0);
  network.live(1ms);
  const std::array<std::int64_t, 4> offsets{0, 15, 10'015, -9'991};
  const std::array<std::int32_t, 4> expected{9'990, 5, 5, 9'999};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    network.left.offset = offsets[i];
    network.right.offset = 32;
    const auto frames = network.sync();
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].length, 4);
    EXPECT_EQ(position(frames[0]), expected[i]);
    EXPECT_EQ(position(frames[1]), -2'147'483'632) << "i32 wraps";
  }
}

TEST(CanopenNode, GivenAReversedEncoderThenItCountsDown) {
  Network network{WheelPairConfig{.left = {.node = 1, .reversed = true}, .right = {.node = 2}}};
  network.live(50ms);
  network.command(0x01, 0);
  network.live(1ms);
  const auto frames = network.sync();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(position(frames[0]), -position(frames[1]));
  EXPECT_EQ(load_i32_le(frames[0].data, 4), -100'000);
}

TEST(CanopenNode, GivenAServiceRequestThenItIsAbortedAsNoSuchObject) {
  Network network;
  network.live(50ms);
  ASSERT_EQ(network.bus.transmit(
                {.id = 0x601, .length = 8, .data = {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}}),
            Status::ok);
  const auto frames = network.live(2ms);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].id, 0x581U);
  EXPECT_EQ(frames[0].data[0], 0x80);
  EXPECT_EQ(load_u16_le(frames[0].data, 1), 0x1018);
  EXPECT_EQ(frames[0].data[3], 0x01);
  EXPECT_EQ(load_u32_le(frames[0].data, 4), 0x0602'0000U);
}

TEST(CanopenNode, GivenServiceDataThenTpdoAndHeartbeatChangeUntilTheNextBoot) {
  Network network;
  network.live(50ms);
  struct Exchange {
    std::array<std::uint8_t, 8> request;
    std::uint8_t answer;
    std::uint32_t value;
  };
  const Exchange exchanges[] = {
      {{0x40, 0x17, 0x10, 0}, 0x43, 100},                  // heartbeat time
      {{0x2B, 0x17, 0x10, 0, 20, 0}, 0x60, 0},             // 20 ms
      {{0x2B, 0x17, 0x10, 0, 0, 0}, 0x80, 0x0609'0030},    // never
      {{0x2F, 0x00, 0x1A, 0, 1}, 0x80, 0x0601'0000},       // the TPDO is on
      {{0x23, 0x00, 0x18, 1, 0x81, 1, 0, 0x80}, 0x60, 0},  // off
      {{0x23, 0x00, 0x18, 1, 0x99, 1, 0, 0x80}, 0x80, 0x0609'0030},
      {{0x2F, 0x00, 0x18, 2, 2}, 0x60, 0},                              // every second SYNC
      {{0x2F, 0x00, 0x18, 2, 255}, 0x80, 0x0609'0030},                  // its own timer
      {{0x23, 0x00, 0x1A, 1, 0x20, 0, 0x6C, 0x60}, 0x80, 0x0601'0000},  // still mapped
      {{0x2F, 0x00, 0x1A, 0, 0}, 0x60, 0},
      {{0x23, 0x00, 0x1A, 1, 0x10, 0, 0x41, 0x60}, 0x80, 0x0604'0041},
      {{0x23, 0x00, 0x1A, 1, 0x20, 0, 0x6C, 0x60}, 0x60, 0},  // the velocity
      {{0x2F, 0x00, 0x1A, 0, 3}, 0x80, 0x0604'0041},
      {{0x2F, 0x00, 0x1A, 0, 1}, 0x60, 0},
      {{0x40, 0x00, 0x1A, 1}, 0x43, 0x606C'0020},
      {{0x23, 0x00, 0x18, 1, 0x81, 1, 0, 0}, 0x60, 0},  // on
      {{0x40, 0x00, 0x18, 2}, 0x43, 2},
      {{0x60, 0x00, 0x18, 2}, 0x80, 0x0504'0001}};
  for (const Exchange& exchange : exchanges) {
    ASSERT_EQ(network.bus.transmit({.id = 0x601, .length = 8, .data = exchange.request}),
              Status::ok);
    CanFrame answer{};
    for (const CanFrame& frame : network.live(2ms)) {
      if (frame.id == 0x581) { answer = frame; }
    }
    EXPECT_EQ(answer.data[0], exchange.answer) << load_u32_le(exchange.request, 0);
    EXPECT_EQ(load_u32_le(answer.data, 4), exchange.value) << load_u32_le(exchange.request, 0);
  }
  network.command(0x01, 1);
  network.live(100ms);  // the new period counts from the next heartbeat on
  std::size_t heartbeats = 0;
  for (const CanFrame& frame : network.live(100ms)) { heartbeats += frame.id == 0x701 ? 1U : 0U; }
  EXPECT_EQ(heartbeats, 5U);
  EXPECT_TRUE(network.sync().empty());
  const auto frames = network.sync();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].length, 4);
  EXPECT_EQ(position(frames[0]), 100'000) << "the velocity";

  network.command(0x82, 1);
  network.live(50ms);
  network.command(0x01, 1);
  network.live(1ms);
  const auto again = network.sync();
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].length, 8);
}

TEST(CanopenNode, GivenASyncProducerAmongTheNodesThenNobodyElseNeedsToSendSync) {
  Network network{WheelPairConfig{.sync_period = 10ms}};
  network.live(50ms);
  network.command(0x01, 0);
  const auto frames = network.live(100ms);
  std::size_t syncs = 0;
  std::size_t pdos = 0;
  for (const CanFrame& frame : frames) {
    syncs += frame.id == 0x080 ? 1U : 0U;
    pdos += frame.id == 0x181 || frame.id == 0x182 ? 1U : 0U;
  }
  EXPECT_EQ(syncs, 10U);
  EXPECT_EQ(pdos, 18U) << "the first SYNC came before the start command";
}

TEST(CanopenNode, GivenAPowerLossThenItBootsAnewAndRestartsItsCount) {
  FaultList faults;
  ASSERT_TRUE(faults.push_back(
      {.device = Device::wheel_left, .kind = FaultKind::disconnect, .begin = 200ms, .end = 300ms}));
  Network network{WheelPairConfig{}, faults};
  network.live(50ms);
  network.command(0x01, 0);
  network.live(100ms);
  EXPECT_EQ(network.sync().size(), 2U);
  network.live(100ms);
  const auto during = network.sync();
  ASSERT_EQ(during.size(), 1U);
  EXPECT_EQ(during[0].id, 0x182U);
  bool booted = false;
  for (const CanFrame& frame : network.live(100ms)) {
    booted = booted || (frame.id == 0x701 && frame.data[0] == 0x00);
  }
  EXPECT_TRUE(booted);
  network.command(0x01, 0);
  network.live(1ms);
  const auto after = network.sync();
  ASSERT_EQ(after.size(), 2U);
  EXPECT_LT(position(after[0]), position(after[1]) - 25'000);
}

}  // namespace
}  // namespace picolo::sim
