// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the port delivers, and what it keeps out.

#include <array>

#include "can_bench.hpp"
#include "wirings.hpp"

namespace picolo::test {
namespace {

constexpr CanFrame kLast{.id = 0x7F0};
constexpr CanFilter kLastFilter{.id = 0x7F0};

TEST_P(CanPort, DeliversOnlyWhatItsFiltersAccept) {
  const std::array filters{CanFilter{.id = 0x182},
                           CanFilter{.id = 0x900, .mask = 0x1FFFFF00, .extended = true},
                           kLastFilter};
  open(filters);
  const CanFrame sent[] = {{.id = 0x182, .length = 8},       {.id = 0x183},
                           {.id = 0x182, .extended = true},  {.id = 0x182, .remote = true},
                           {.id = 0x901, .extended = true},  {.id = 0xA01, .extended = true},
                           {.id = 0x100, .extended = false}, kLast};
  for (const CanFrame& frame : sent) { ASSERT_TRUE(other.send(frame)); }
  const auto frames = frames_until(kLast.id);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].id, 0x182U);
  EXPECT_FALSE(frames[0].extended);
  EXPECT_EQ(frames[1].id, 0x901U);
  EXPECT_TRUE(frames[1].extended);
  EXPECT_EQ(bus.status().received, 3U);
}

TEST_P(CanPort, StampsAreTheKernelsAndLieBetweenSendingAndReading) {
  open();
  Timestamp last{};
  for (int round = 0; round < 10; ++round) {
    const Timestamp before = clock.now();
    ASSERT_TRUE(other.send(CanFrame{.id = 0x181, .length = 8}));
    settle();
    const auto frame = next(bus);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->source, StampSource::kernel);
    EXPECT_GE(frame->stamp, before - 1ms);
    EXPECT_LE(frame->stamp, clock.now());
    EXPECT_GE(frame->stamp, last);
    last = frame->stamp;
    EXPECT_EQ(bus.receive().status(), Status::not_ready);
  }
}

TEST_P(CanPort, OwnFramesDoNotComeBackButThoseOfOtherProgramsOnThisMachineDo) {
  open();
  ASSERT_EQ(bus.transmit({.id = 0x201, .length = 1, .data = {7}}), Status::ok);
  const auto heard = other.receive();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->id, 0x201U);
  EXPECT_EQ(heard->data[0], 7);
  const CanNode neighbour{GetParam().port};
  ASSERT_TRUE(neighbour.send(CanFrame{.id = 0x202}));
  ASSERT_TRUE(other.send(kLast));
  const auto frames = frames_until(kLast.id);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].id, 0x202U);
}

TEST_P(CanPort, AForeignTalkerOnAnIdentifierOfOursIsCountedAndKeptOut) {
  const std::array filters{CanFilter{.id = 0x181}, kLastFilter};
  const std::array ours{CanFilter{.id = 0x200, .mask = 0x7F0}};
  ASSERT_EQ(bus.open(GetParam().port.c_str(), filters, ours), Status::ok);
  ASSERT_EQ(bus.transmit({.id = 0x201}), Status::ok);
  ASSERT_TRUE(other.receive());
  ASSERT_TRUE(other.send(CanFrame{.id = 0x201}));
  ASSERT_TRUE(other.send(CanFrame{.id = 0x20F}));
  ASSERT_TRUE(other.send(CanFrame{.id = 0x210}));
  ASSERT_TRUE(other.send(kLast));
  EXPECT_TRUE(frames_until(kLast.id).empty());
  EXPECT_EQ(bus.counters().foreign_talkers, 2U);
}

TEST_P(CanPort, WhatTheKernelDropsIsCountedToTheFrame) {
  SocketCanBus small{clock, {.receive_buffer_bytes = 16'384}};
  ASSERT_EQ(small.open(GetParam().port.c_str()), Status::ok);
  EXPECT_LE(small.receive_buffer_bytes(), 32'768);
  constexpr std::uint32_t kSent = 400;
  for (std::uint32_t i = 0; i < kSent; ++i) { ASSERT_TRUE(other.send(CanFrame{.id = 0x181})); }
  settle();
  while (next(small)) {}
  // The kernel tells with the next frame that it can deliver.
  ASSERT_TRUE(other.send(CanFrame{.id = 0x181}));
  ASSERT_TRUE(next(small));
  EXPECT_GT(small.status().rx_lost, 0U);
  EXPECT_EQ(small.status().received + small.status().rx_lost, kSent + 1);
}

// A third of a second of a full bus of 1 Mbit/s, when it may have what it asks for.
TEST_P(CanPort, HoldsWhatItsBufferWasGranted) {
  open();
  constexpr int kBytesPerFrame = 768;  // in the kernel's account
  const int frames = bus.receive_buffer_bytes() / kBytesPerFrame - 10;
  for (int i = 0; i < frames; ++i) { ASSERT_TRUE(other.send(CanFrame{.id = 0x181})); }
  ASSERT_TRUE(other.send(kLast));
  EXPECT_EQ(frames_until(kLast.id).size(), static_cast<std::size_t>(frames));
  EXPECT_EQ(bus.status().rx_lost, 0U);
}

// Only a virtual interface of this kernel carries CAN FD; a classic controller refuses to.
TEST(VcanFd, FramesOfCanFdAreIgnoredAndDoNoHarm) {
  LinuxClock clock;
  SocketCanBus bus{clock};
  ASSERT_EQ(bus.open("vcan0"), Status::ok);
  const CanNode other{"vcan0"};
  canfd_frame fd{};
  fd.can_id = 0x181;
  fd.len = 64;
  ASSERT_TRUE(other.send(fd));
  ASSERT_TRUE(other.send(kLast));
  const auto frame = next(bus);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, kLast.id);
  EXPECT_EQ(bus.status().received, 1U);
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Vcan, CanPort, ::testing::Values(vcan()));
INSTANTIATE_TEST_SUITE_P(Sja1000, CanPort, ::testing::Values(controllers()));

}  // namespace picolo::test
