// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What touches the whole machine: its wall clock, its scheduler, its watchdog. Only ever run in the
// virtual machine.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>

#include "can_node.hpp"
#include "picolo/linux/device_watchdog.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/realtime.hpp"
#include "picolo/linux/socket_can_bus.hpp"

namespace picolo::test {
namespace {

void step_wall_clock(std::chrono::seconds step) {
  timespec now{};
  ASSERT_EQ(::clock_gettime(CLOCK_REALTIME, &now), 0);
  now.tv_sec += step.count();
  ASSERT_EQ(::clock_settime(CLOCK_REALTIME, &now), 0);
}

class MachineClock : public ::testing::TestWithParam<std::chrono::seconds> {
 protected:
  void SetUp() override {
    ASSERT_EQ(bus.open("vcan0"), Status::ok);
    ASSERT_EQ(bus.receive().status(), Status::not_ready);  // the end of a first drain
  }
  void TearDown() override { step_wall_clock(-GetParam()); }

  /// Sends a frame, and keeps when.
  void send(std::size_t number) {
    departures_[number] = clock.now();
    ASSERT_TRUE(other.send(CanFrame{.id = 0x181, .length = 1}));
    arrivals_[number] = clock.now();
    settle();
  }
  /// Its stamp is the kernel's, and true.
  void expect_stamp(const Result<CanFrame>& frame, std::size_t number) {
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->source, StampSource::kernel) << number;
    EXPECT_GE(frame->stamp, departures_[number] - 1ms) << number;
    EXPECT_LE(frame->stamp, arrivals_[number] + 5ms) << number;
  }

  LinuxClock clock;
  CanNode other{"vcan0"};
  SocketCanBus bus{clock};
  std::array<Timestamp, 4> departures_{};
  std::array<Timestamp, 4> arrivals_{};
};

TEST_P(MachineClock, AStepBetweenTwoDrainsSpoilsNoStamp) {
  send(0);
  step_wall_clock(GetParam());
  send(1);
  expect_stamp(next(bus), 0);
  expect_stamp(next(bus), 1);
  EXPECT_EQ(bus.receive().status(), Status::not_ready);
  send(2);
  expect_stamp(next(bus), 2);
  EXPECT_EQ(bus.stamps().clock_steps(), 1U);
  EXPECT_EQ(bus.stamps().misfits(), 0U);
}

TEST_P(MachineClock, AStepWithinADrainSpoilsNoStamp) {
  send(0);
  send(1);
  expect_stamp(bus.receive(), 0);
  step_wall_clock(GetParam());
  send(2);
  expect_stamp(bus.receive(), 1);
  expect_stamp(bus.receive(), 2);
  EXPECT_EQ(bus.stamps().clock_steps(), 1U);
  EXPECT_EQ(bus.stamps().misfits(), 0U);
}

TEST_P(MachineClock, AStepDoesNotMoveTheMonotonicClockNorASleep) {
  const Timestamp begin = clock.now();
  step_wall_clock(GetParam());
  EXPECT_EQ(sleep_until(begin + 50ms), Status::ok);
  EXPECT_GE(clock.now(), begin + 50ms);
  EXPECT_LT(clock.now(), begin + 30min);
}

INSTANTIATE_TEST_SUITE_P(OneHour, MachineClock, ::testing::Values(3600, -3600));

TEST(MachineRealtime, MemoryIsLockedAndTheThreadComesFirst) {
  ASSERT_EQ(lock_memory(), Status::ok);
  std::ifstream file{"/proc/self/status"};
  std::string line;
  while (std::getline(file, line) && line.rfind("VmLck:", 0) != 0) {}
  EXPECT_NE(line.find("kB"), std::string::npos);
  EXPECT_EQ(line.find(" 0 kB"), std::string::npos) << line;
  ::munlockall();

  ASSERT_EQ(use_fifo_priority(40), Status::ok);
  sched_param parameters{};
  EXPECT_EQ(::sched_getscheduler(0), SCHED_FIFO);
  EXPECT_EQ(::sched_getparam(0, &parameters), 0);
  EXPECT_EQ(parameters.sched_priority, 40);
  parameters.sched_priority = 0;
  EXPECT_EQ(::sched_setscheduler(0, SCHED_OTHER, &parameters), 0);
}

/// The software watchdog of the kernel, told to say in the log that it would have reset the
/// machine.
class MachineWatchdog : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(log.is_open());
    ASSERT_GE(::lseek(log.get(), 0, SEEK_END), 0);
    ASSERT_EQ(watchdog.open("/dev/watchdog", 1s), Status::ok);
  }
  void TearDown() override {
    if (!watchdog.is_open()) { ASSERT_EQ(watchdog.open("/dev/watchdog"), Status::ok); }
    watchdog.disarm();
  }
  /// Whether it has fired since the last call.
  bool fired() {
    std::array<char, 4096> text{};
    bool found = false;
    for (ssize_t size = 0; (size = ::read(log.get(), text.data(), text.size())) > 0;) {
      const std::string message{text.data(), static_cast<std::size_t>(size)};
      found = found || message.find("softdog: Triggered") != std::string::npos;
    }
    return found;
  }
  void wait(Duration duration) { ASSERT_EQ(sleep_until(clock.now() + duration), Status::ok); }

  LinuxClock clock;
  FileDescriptor log{::open("/dev/kmsg", O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  DeviceWatchdog watchdog;
};

TEST_F(MachineWatchdog, FiresOnlyWhenTheStrokesStop) {
  EXPECT_EQ(watchdog.timeout(), Duration{1s});
  for (int i = 0; i < 8; ++i) {
    watchdog.stroke();
    wait(250ms);
  }
  EXPECT_FALSE(fired());
  wait(1500ms);
  EXPECT_TRUE(fired());
  EXPECT_EQ(watchdog.failures(), 0U);
}

TEST_F(MachineWatchdog, IsQuietAfterTheOrderlyEnd) {
  watchdog.stroke();
  watchdog.disarm();
  wait(1500ms);
  EXPECT_FALSE(fired());
}

TEST_F(MachineWatchdog, FiresWhenTheProgramEndsWithoutIt) {
  watchdog = DeviceWatchdog{};
  wait(1500ms);
  EXPECT_TRUE(fired());
}

TEST_F(MachineWatchdog, IsRefusedToASecondProgramAndForATimeThatItCannotDo) {
  DeviceWatchdog second;
  EXPECT_EQ(second.open("/dev/watchdog"), Status::io_error);
  watchdog.disarm();
  EXPECT_EQ(second.open("/dev/watchdog", 1'000'000s), Status::unsupported);
  EXPECT_FALSE(second.is_open());
}

}  // namespace
}  // namespace picolo::test
