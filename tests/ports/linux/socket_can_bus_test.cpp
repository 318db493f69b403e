// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What a CAN socket does beyond carrying frames: stamps, error frames, other kinds of frames, an
// interface that goes away.

#include "picolo/linux/socket_can_bus.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "can_pair.hpp"
#include "picolo/linux/linux_clock.hpp"

namespace picolo {
namespace {

/// The monotonic clock as it would look after the wall clock was stepped: kernel stamps do not fit
/// it.
class SteppedClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() override { return base_.now() + step; }
  Duration step{};

 private:
  LinuxClock base_;
};

class SocketCanBusTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(bus.adopt(pair.take_port()), Status::ok); }

  /// One drain: everything that waits.
  std::vector<CanFrame> drain() {
    std::vector<CanFrame> frames;
    for (auto frame = bus.receive(); frame; frame = bus.receive()) { frames.push_back(*frame); }
    return frames;
  }

  SteppedClock clock;
  test::CanPair pair;
  SocketCanBus bus{clock};
};

TEST_F(SocketCanBusTest, GivenFramesThenTheyCarryKernelStampsBetweenSendingAndNow) {
  for (int round = 0; round < 20; ++round) {
    const Timestamp before = clock.now();
    ASSERT_TRUE(pair.send(CanFrame{.id = 0x181, .length = 8}));
    const Timestamp after = clock.now();
    ASSERT_EQ(sleep_until(after + 2ms), Status::ok);
    const auto frames = drain();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].source, StampSource::kernel);
    // The pair of clocks is read with an error of microseconds, unless the test is interrupted
    // right there.
    EXPECT_GE(frames[0].stamp, before - 1ms);
    EXPECT_LE(frames[0].stamp, clock.now());
  }
  EXPECT_EQ(bus.stamps().misfits(), 0U);
}

TEST_F(SocketCanBusTest, GivenAStepOfTheWallClockThenFramesAreStampedWithTheReadAndCounted) {
  for (const Duration step : {Duration{1h}, Duration{2h}}) {
    drain();
    clock.step = step;
    drain();  // from here on the queue is known to have been empty after the step
    clock.step = step + 1h;
    ASSERT_TRUE(pair.send(CanFrame{.id = 0x181}));
    const Timestamp before = clock.now();
    const std::uint32_t misfits = bus.stamps().misfits();
    const auto frames = drain();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].source, StampSource::read);
    EXPECT_GE(frames[0].stamp, before);
    EXPECT_EQ(bus.stamps().misfits(), misfits + 1);
  }
}

TEST_F(SocketCanBusTest, GivenAStampInTheFutureThenTheTimeOfTheReadIsTaken) {
  drain();
  clock.step = -1h;
  ASSERT_TRUE(pair.send(CanFrame{.id = 0x181}));
  const auto frames = drain();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].source, StampSource::read);
  EXPECT_LE(frames[0].stamp, clock.now());
}

TEST_F(SocketCanBusTest, GivenCanFdFramesThenTheyAreIgnoredAndCounted) {
  canfd_frame fd{};
  fd.can_id = 0x181;
  fd.len = 64;
  ASSERT_TRUE(pair.send(fd));
  ASSERT_TRUE(pair.send(CanFrame{.id = 0x182}));
  const auto frames = drain();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].id, 0x182U);
  EXPECT_EQ(bus.counters().not_classic, 1U);
}

TEST_F(SocketCanBusTest, GivenATornDatagramThenItIsIgnored) {
  const std::array<std::uint8_t, 5> rubbish{1, 2, 3, 4, 5};
  ASSERT_TRUE(pair.send(rubbish));
  EXPECT_TRUE(drain().empty());
  EXPECT_EQ(bus.counters().not_classic, 1U);
}

TEST_F(SocketCanBusTest, GivenALengthBeyondEightThenItIsEight) {
  can_frame raw{};
  raw.can_id = 0x123;
  raw.can_dlc = 15;
  ASSERT_TRUE(pair.send(raw));
  EXPECT_EQ(bus.receive()->length, 8);
}

TEST_F(SocketCanBusTest, GivenManyForeignDatagramsThenOneCallStaysBounded) {
  canfd_frame fd{};
  for (int i = 0; i < 40; ++i) { ASSERT_TRUE(pair.send(fd)); }
  ASSERT_TRUE(pair.send(CanFrame{.id = 0x181}));
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  EXPECT_LT(bus.counters().not_classic, 40U);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  EXPECT_EQ(bus.receive()->id, 0x181U);
  EXPECT_EQ(bus.counters().not_classic, 40U);
}

struct ErrorCase {
  std::uint32_t kind;
  std::uint8_t controller;
  CanState state;
};

class SocketCanErrors : public SocketCanBusTest, public ::testing::WithParamInterface<ErrorCase> {};

TEST_P(SocketCanErrors, SetTheStateAndNeverReachTheCaller) {
  ASSERT_TRUE(pair.send_error(GetParam().kind, GetParam().controller));
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  EXPECT_EQ(bus.status().state, GetParam().state);
  EXPECT_EQ(bus.status().error_frames, 1U);
  EXPECT_EQ(bus.status().received, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    All, SocketCanErrors,
    ::testing::Values(ErrorCase{CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING, CanState::warning},
                      ErrorCase{CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, CanState::warning},
                      ErrorCase{CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, CanState::passive},
                      ErrorCase{CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, CanState::passive},
                      ErrorCase{CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, CanState::active},
                      ErrorCase{CAN_ERR_BUSOFF, 0, CanState::bus_off},
                      ErrorCase{CAN_ERR_RESTARTED, 0, CanState::active},
                      ErrorCase{CAN_ERR_ACK, 0, CanState::active}));

TEST_F(SocketCanBusTest, GivenBusOffAndARestartThenTheRestartIsCounted) {
  ASSERT_TRUE(pair.send_error(CAN_ERR_BUSOFF));
  ASSERT_TRUE(pair.send_error(CAN_ERR_RESTARTED));
  drain();
  EXPECT_EQ(bus.status().state, CanState::active);
  EXPECT_EQ(bus.status().restarts, 1U);
}

TEST_F(SocketCanBusTest, GivenAnOverflowOfTheControllerThenALossIsCounted) {
  ASSERT_TRUE(pair.send_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW));
  drain();
  EXPECT_EQ(bus.status().rx_lost, 1U);
}

TEST_F(SocketCanBusTest, GivenAFullQueueThenSendingResumesAfterIt) {
  Status status = Status::ok;
  std::uint32_t accepted = 0;
  for (; is_ok(status); ++accepted) { status = bus.transmit({.id = 1, .length = 8}); }
  EXPECT_EQ(status, Status::full);
  EXPECT_EQ(bus.status().transmitted, accepted - 1);
  while (pair.receive()) {}
  EXPECT_EQ(bus.transmit({.id = 1}), Status::ok);
}

TEST_F(SocketCanBusTest, GivenAClosedPeerThenDisconnectedAndNoSignal) {
  pair.close();
  EXPECT_EQ(bus.receive().status(), Status::disconnected);
  EXPECT_EQ(bus.transmit({.id = 1}), Status::disconnected);
  EXPECT_EQ(bus.status().state, CanState::absent);
}

TEST(SocketCanBus, GivenNoSocketThenDisconnected) {
  LinuxClock clock;
  SocketCanBus bus{clock};
  EXPECT_EQ(bus.receive().status(), Status::disconnected);
  EXPECT_EQ(bus.transmit({.id = 1}), Status::disconnected);
  EXPECT_FALSE(bus.is_open());
}

TEST(SocketCanBus, GivenNoSuchInterfaceThenDisconnected) {
  LinuxClock clock;
  SocketCanBus bus{clock};
  EXPECT_EQ(bus.open("no_such_can0"), Status::disconnected);
}

TEST(SocketCanBus, GivenAnInterfaceThatIsNoCanThenItIsRefused) {
  LinuxClock clock;
  SocketCanBus bus{clock};
  const std::array filters{CanFilter{.id = 0x181}};
  const Status status = bus.open("lo", filters);
  // Without CAN in the kernel the socket cannot be made; with it "lo" cannot be bound.
  EXPECT_TRUE(status == Status::unsupported || status == Status::disconnected) << to_string(status);
  EXPECT_FALSE(bus.is_open());
  const std::vector<CanFilter> too_many(100);
  EXPECT_EQ(bus.open("lo", too_many), Status::invalid_argument);
}

TEST(SocketCanBus, GivenABadDescriptorThenAdoptRefuses) {
  LinuxClock clock;
  SocketCanBus bus{clock};
  EXPECT_EQ(bus.adopt(-1), Status::io_error);
  EXPECT_FALSE(bus.is_open());
}

}  // namespace
}  // namespace picolo
