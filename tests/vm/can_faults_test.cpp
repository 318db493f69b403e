// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A bus that has errors, and an interface that goes away.

#include <linux/can/error.h>
#include <unistd.h>

#include "can_bench.hpp"
#include "wirings.hpp"

namespace picolo::test {
namespace {

class CanFaults : public CanPort {
 protected:
  /// Runs `command` while the port is open; afterwards the port has noticed that the interface
  /// went.
  void lose_interface(const std::string& command) {
    shell(command);
    EXPECT_EQ(next(bus).status(), Status::disconnected);
    EXPECT_EQ(bus.status().state, CanState::absent);
    EXPECT_EQ(bus.transmit({.id = 1}), Status::disconnected);
  }
  /// Waits for the port to find the interface again.
  void expect_back() {
    for (int i = 0; i < 200 && bus.receive().status() == Status::disconnected; ++i) { settle(); }
    EXPECT_EQ(bus.status().state, CanState::active);
    const CanNode again{GetParam().other};
    ASSERT_TRUE(again.send(CanFrame{.id = 0x181}));
    const auto frame = next(bus);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, 0x181U);
    EXPECT_EQ(bus.transmit({.id = 0x201}), Status::ok);
    const auto heard = again.receive();
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->id, 0x201U);
  }
};

TEST_P(CanFaults, ErrorFramesBecomeTheStateOfTheBusAndNothingElse) {
  open();
  const CanNode controller{GetParam().port};
  const struct {
    std::uint32_t kind;
    std::uint8_t detail;
    CanState state;
  } steps[] = {{CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, CanState::warning},
               {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, CanState::passive},
               {CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, CanState::active},
               {CAN_ERR_BUSOFF, 0, CanState::bus_off},
               {CAN_ERR_RESTARTED, 0, CanState::active}};
  for (const auto& step : steps) {
    ASSERT_TRUE(controller.send_error(step.kind, step.detail));
    for (int i = 0; i < 50 && bus.status().state != step.state; ++i) {
      EXPECT_EQ(bus.receive().status(), Status::not_ready);
      settle();
    }
    EXPECT_EQ(bus.status().state, step.state);
  }
  EXPECT_EQ(bus.status().error_frames, 5U);
  EXPECT_EQ(bus.status().restarts, 1U);
  EXPECT_EQ(bus.status().received, 0U);
}

TEST_P(CanFaults, AnInterfaceThatGoesDownAndUpIsNoticedBothTimes) {
  open();
  lose_interface("/sbin/ip link set " + GetParam().port + " down");
  set_link("up");
  expect_back();
  EXPECT_EQ(bus.counters().reopened, 0U);
}

TEST_P(CanFaults, AnInterfaceThatIsDeletedAndMadeAnewIsFoundAgain) {
  open();
  lose_interface(GetParam().remove);
  for (int i = 0; i < 40; ++i) {
    settle();
    EXPECT_FALSE(bus.receive());
  }
  shell(GetParam().make);
  expect_back();
  EXPECT_EQ(bus.counters().reopened, 1U);
}

TEST_P(CanFaults, AnInterfaceThatIsNotThereYetIsWaitedFor) {
  shell(GetParam().remove);
  EXPECT_EQ(bus.open(GetParam().port.c_str()), Status::disconnected);
  EXPECT_EQ(bus.receive().status(), Status::disconnected);
  shell(GetParam().make);
  expect_back();
}

TEST_P(CanFaults, AnInterfaceThatIsDownAtTheStartIsWaitedFor) {
  set_link("down");
  EXPECT_EQ(bus.open(GetParam().port.c_str()), Status::ok);
  EXPECT_EQ(bus.receive().status(), Status::disconnected);
  EXPECT_EQ(bus.status().state, CanState::absent);
  set_link("up");
  expect_back();
}

// A queue of four frames, of which none leaves before 200 ms.
TEST_P(CanFaults, AFullQueueRefusesFramesAndIsNeverWedged) {
  shell("/sbin/tc qdisc replace dev " + GetParam().port + " root netem delay 200ms limit 4");
  open();
  for (int round = 0; round < 3; ++round) {
    Status status = Status::ok;
    std::uint32_t accepted = 0;
    for (int i = 0; i < 50 && !is_ok(bus.transmit({.id = 0x2FF})); ++i) { settle(); }
    ASSERT_TRUE(other.receive()) << "round " << round;
    for (std::uint32_t i = 0; i < 20 && is_ok(status); ++i) {
      status = bus.transmit({.id = 0x300 + i});
      accepted += is_ok(status) ? 1U : 0U;
    }
    EXPECT_EQ(status, Status::full);
    EXPECT_LE(accepted, 4U);
    EXPECT_EQ(bus.status().state, CanState::active);
    EXPECT_EQ(bus.receive().status(), Status::not_ready);
    for (std::uint32_t i = 0; i < accepted; ++i) {
      const auto heard = other.receive();
      ASSERT_TRUE(heard) << "round " << round;
      EXPECT_EQ(heard->id, 0x300 + i);
    }
  }
  EXPECT_GE(bus.status().tx_refused, 3U);
  shell("/sbin/tc qdisc del dev " + GetParam().port + " root");
  EXPECT_EQ(bus.transmit({.id = 0x3FF}), Status::ok);
  EXPECT_TRUE(other.receive());
}

TEST_P(CanFaults, ABusThatIsOffTakesNothingAndIsFoundOnAgain) {
  open();
  const CanNode controller{GetParam().port};
  ASSERT_TRUE(controller.send_error(CAN_ERR_BUSOFF));
  for (int i = 0; i < 50 && bus.status().state != CanState::bus_off; ++i) {
    EXPECT_FALSE(bus.receive());
    ::usleep(1000);
  }
  EXPECT_EQ(bus.transmit({.id = 1}), Status::full);
  EXPECT_EQ(bus.status().tx_refused, 1U);
  // The frame that tells of the restart is lost; the interface itself tells.
  for (int i = 0; i < 100 && bus.status().state == CanState::bus_off; ++i) {
    EXPECT_FALSE(bus.receive());
    settle();
  }
  EXPECT_EQ(bus.status().state, CanState::active);
  EXPECT_EQ(bus.transmit({.id = 1}), Status::ok);
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Vcan, CanFaults, ::testing::Values(vcan()));
INSTANTIATE_TEST_SUITE_P(Sja1000, CanFaults, ::testing::Values(controllers()));

}  // namespace picolo::test
