// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Faults do what they say, when they say, as often as they say, and nothing else.

#include "picolo/sim/fault_plan.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "picolo/sim/links.hpp"
#include "picolo/sim/sim_clock.hpp"

namespace picolo::sim {
namespace {

FaultList list(std::initializer_list<Fault> faults) {
  FaultList result;
  for (const Fault& fault : faults) {
    EXPECT_TRUE(fault.valid());
    EXPECT_TRUE(result.push_back(fault));
  }
  return result;
}

Fault fault(FaultKind kind, float probability = 1.0F, Device device = Device::lidar) {
  return {.device = device,
          .kind = kind,
          .begin = 1s,
          .end = 2s,
          .probability = probability,
          .delay = 50ms};
}

TEST(FaultPlan, GivenAWindowThenItHoldsFromItsBeginToBeforeItsEnd) {
  FaultPlan plan{1, list({fault(FaultKind::drop)})};
  EXPECT_FALSE(plan.judge(Device::lidar, 1s - 1us).drop);
  EXPECT_TRUE(plan.judge(Device::lidar, 1s).drop);
  EXPECT_TRUE(plan.judge(Device::lidar, 2s - 1us).drop);
  EXPECT_FALSE(plan.judge(Device::lidar, 2s).drop);
  EXPECT_EQ(plan.counters(Device::lidar).dropped, 2U);
}

TEST(FaultPlan, GivenAnotherDeviceThenNothingHappensToIt) {
  FaultPlan plan{1, list({fault(FaultKind::drop)})};
  for (const Device device : {Device::wheel_left, Device::wheel_right, Device::imu}) {
    EXPECT_FALSE(plan.judge(device, 1500ms).drop);
  }
}

TEST(FaultPlan, GivenAProbabilityThenThatShareIsStruck) {
  for (const FaultKind kind :
       {FaultKind::drop, FaultKind::corrupt, FaultKind::delay, FaultKind::duplicate}) {
    FaultPlan plan{3, list({fault(kind, 0.3F)})};
    int struck = 0;
    for (int i = 0; i < 10'000; ++i) {
      const FaultVerdict verdict = plan.judge(Device::lidar, 1500ms);
      const bool hit =
          verdict.drop || verdict.corrupt || verdict.duplicate || verdict.delay == 50ms;
      struck += hit ? 1 : 0;
    }
    EXPECT_NEAR(struck, 3000, 4 * 46);
    const FaultCounters& counters = plan.counters(Device::lidar);
    EXPECT_EQ(counters.dropped + counters.corrupted + counters.delayed + counters.duplicated,
              static_cast<std::uint32_t>(struck));
  }
}

TEST(FaultPlan, GivenAFurtherFaultThenTheOthersStrikeTheSamePackets) {
  FaultPlan alone{3, list({fault(FaultKind::drop, 0.3F)})};
  FaultPlan joined{3, list({fault(FaultKind::drop, 0.3F), fault(FaultKind::corrupt, 0.5F)})};
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(alone.judge(Device::lidar, 1500ms).drop, joined.judge(Device::lidar, 1500ms).drop);
  }
}

TEST(FaultPlan, GivenAFaultOfTheBusThenBothWheelsSufferAndNoSerialDevice) {
  FaultPlan plan{1, list({fault(FaultKind::drop, 1.0F, Device::can_bus)})};
  EXPECT_TRUE(plan.judge(Device::wheel_left, 1500ms).drop);
  EXPECT_TRUE(plan.judge(Device::wheel_right, 1500ms).drop);
  EXPECT_FALSE(plan.judge(Device::lidar, 1500ms).drop);
  EXPECT_FALSE(plan.judge(Device::imu, 1500ms).drop);
}

TEST(FaultPlan, GivenADisconnectedBusThenTheNodesKeepTheirPower) {
  FaultPlan plan{1, list({fault(FaultKind::disconnect, 1.0F, Device::can_bus)})};
  EXPECT_TRUE(plan.active(Device::can_bus, FaultKind::disconnect, 1500ms));
  EXPECT_FALSE(plan.active(Device::wheel_left, FaultKind::disconnect, 1500ms));
}

TEST(FaultPlan, GivenFreezeOrSilenceThenTheyAreActiveInTheirWindowOnly) {
  FaultPlan plan{1, list({fault(FaultKind::freeze), fault(FaultKind::silence)})};
  for (const FaultKind kind : {FaultKind::freeze, FaultKind::silence}) {
    EXPECT_FALSE(plan.active(Device::lidar, kind, 999ms));
    EXPECT_TRUE(plan.active(Device::lidar, kind, 1s));
    EXPECT_FALSE(plan.active(Device::lidar, kind, 2s));
  }
}

TEST(FaultPlan, WhenCorruptingThenOneToThreeBitsFlip) {
  FaultPlan plan{9, {}};
  std::array<int, 5> histogram{};
  for (int i = 0; i < 3000; ++i) {
    std::array<std::uint8_t, 47> bytes{};
    plan.corrupt(bytes);
    int flipped = 0;
    for (const std::uint8_t byte : bytes) { flipped += __builtin_popcount(byte); }
    ASSERT_LE(flipped, 3);  // two flips of one bit undo each other
    ++histogram[static_cast<std::size_t>(flipped)];
  }
  for (std::size_t flips = 1; flips <= 3; ++flips) { EXPECT_GT(histogram[flips], 800); }
}

class SerialLinkTest : public ::testing::Test {
 protected:
  /// Sends packets of 10 bytes every 10 ms for 3 s; returns the arrival of every whole packet.
  std::vector<Timestamp> run(const Fault& f) {
    FaultPlan plan{5, list({f})};
    SerialLink link{port, plan, Device::lidar, start};
    std::array<std::uint8_t, 10> packet{};
    std::vector<Timestamp> arrivals;
    std::size_t pending = 0;
    for (Timestamp t = start; t < start + 3s; t += 10ms) {
      link.update(t);
      link.send(packet, t);
      clock.set(t + 9ms);
      std::array<std::uint8_t, 10> buffer{};
      for (auto read = port.read(buffer); read; read = port.read(buffer)) {
        pending += read->size;
        for (; pending >= 10; pending -= 10) { arrivals.push_back(read->last_byte_stamp); }
      }
    }
    return arrivals;
  }
  [[nodiscard]] static std::size_t within(const std::vector<Timestamp>& stamps, Timestamp begin,
                                          Timestamp end) {
    std::size_t count = 0;
    for (const Timestamp stamp : stamps) { count += stamp >= begin && stamp < end ? 1U : 0U; }
    return count;
  }

  Timestamp start{100s};
  SimClock clock{start};
  SimSerialPort port{clock, 115'200};
};

TEST_F(SerialLinkTest, GivenSilenceThenNothingComesInTheWindowAndAllOutsideOfIt) {
  const auto arrivals = run(fault(FaultKind::silence));
  EXPECT_EQ(within(arrivals, start, start + 1s), 100U);
  EXPECT_EQ(within(arrivals, start + 1s, start + 2s), 0U);
  EXPECT_EQ(within(arrivals, start + 2s, start + 3s), 100U);
}

TEST_F(SerialLinkTest, GivenDelayThenPacketsComeLateButAllComeInOrder) {
  const auto arrivals = run(fault(FaultKind::delay));
  ASSERT_EQ(arrivals.size(), 300U);
  const Duration line = transmission_time(10, 115'200);
  EXPECT_EQ(arrivals[99], start + 990ms + line);
  EXPECT_EQ(arrivals[100], start + 1000ms + 50ms + line);
  EXPECT_EQ(arrivals[250], start + 2500ms + line);
}

TEST_F(SerialLinkTest, GivenDuplicationThenEveryPacketComesTwice) {
  const auto arrivals = run(fault(FaultKind::duplicate));
  EXPECT_EQ(arrivals.size(), 400U);
}

TEST_F(SerialLinkTest, GivenDisconnectionThenThePortSaysSoAndComesBack) {
  FaultPlan plan{5, list({fault(FaultKind::disconnect)})};
  SerialLink link{port, plan, Device::lidar, start};
  std::array<std::uint8_t, 4> buffer{};
  link.update(start + 999ms);
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
  link.update(start + 1s);
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
  link.update(start + 2s);
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
}

TEST(CanLink, GivenDelayOnOneNodeThenTheOtherIsNotHeldBack) {
  SimClock clock;
  SimCanBus bus{clock};
  FaultPlan plan{1, list({{.device = Device::wheel_left,
                           .kind = FaultKind::delay,
                           .begin = 0s,
                           .end = 1s,
                           .delay = 30ms}})};
  CanLink left{bus, plan, Device::wheel_left, Timestamp{}};
  CanLink right{bus, plan, Device::wheel_right, Timestamp{}};
  left.send({.stamp = Timestamp{1ms}, .id = 0x181});
  right.send({.stamp = Timestamp{1ms}, .id = 0x182});
  left.release(Timestamp{2ms});
  right.release(Timestamp{2ms});
  clock.set(Timestamp{2ms});
  EXPECT_EQ(bus.receive()->id, 0x182U);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  left.release(Timestamp{31ms});
  clock.set(Timestamp{32ms});
  const auto late = bus.receive();
  ASSERT_TRUE(late);
  EXPECT_EQ(late->id, 0x181U);
  EXPECT_EQ(late->stamp, Timestamp{31ms} + 94us);
}

TEST(CanLink, GivenCorruptionThenThePayloadChangesAndAnEmptyFrameDoesNot) {
  SimClock clock;
  SimCanBus bus{clock};
  FaultPlan plan{
      1,
      list({{.device = Device::wheel_left, .kind = FaultKind::corrupt, .begin = 0s, .end = 1s}})};
  CanLink link{bus, plan, Device::wheel_left, Timestamp{}};
  link.send({.id = 0x181, .length = 2});
  link.send({.id = 0x181, .length = 0});
  link.release(Timestamp{1ms});
  clock.set(Timestamp{2ms});
  const auto damaged = bus.receive();
  ASSERT_TRUE(damaged);
  EXPECT_EQ(damaged->id, 0x181U);
  EXPECT_EQ(damaged->length, 2);
  EXPECT_NE(damaged->data[0] | damaged->data[1], 0);
  EXPECT_EQ(damaged->data[2], 0) << "beyond the payload";
  EXPECT_TRUE(bus.receive());
}

}  // namespace
}  // namespace picolo::sim
