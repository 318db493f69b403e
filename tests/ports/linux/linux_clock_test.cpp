// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The absolute sleep and the watchdog device.

#include "picolo/linux/linux_clock.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>

#include "picolo/linux/device_watchdog.hpp"

namespace picolo {
namespace {

TEST(SleepUntil, GivenAnInstantAheadThenItIsNotOverEarlier) {
  LinuxClock clock;
  const Timestamp wake = clock.now() + 5ms;
  ASSERT_EQ(sleep_until(wake), Status::ok);
  EXPECT_GE(clock.now(), wake);
}

TEST(SleepUntil, GivenAnInstantThatHasPassedThenItReturnsAtOnce) {
  LinuxClock clock;
  EXPECT_EQ(sleep_until(clock.now() - 1s), Status::ok);
  EXPECT_EQ(sleep_until(Timestamp{-1s}), Status::ok);
}

TEST(SleepUntil, GivenASignalThenItReturnsBeforeItsTime) {
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = [](int) {};
  ASSERT_EQ(::sigaction(SIGALRM, &action, &before), 0);
  itimerval timer{};
  timer.it_value.tv_usec = 20'000;
  ASSERT_EQ(::setitimer(ITIMER_REAL, &timer, nullptr), 0);
  LinuxClock clock;
  EXPECT_EQ(sleep_until(clock.now() + 60s), Status::not_ready);
  ASSERT_EQ(::sigaction(SIGALRM, &before, nullptr), 0);
}

TEST(DeviceWatchdog, WhenStrokedThenOneByteIsWrittenAndAMagicOneAtTheEnd) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const FileDescriptor device{ends[0]};
  DeviceWatchdog watchdog;
  watchdog.adopt(ends[1]);
  watchdog.stroke();
  watchdog.stroke();
  watchdog.disarm();
  std::array<char, 8> bytes{};
  EXPECT_EQ(::read(device.get(), bytes.data(), bytes.size()), 3);
  EXPECT_NE(bytes[1], 'V') << "a stroke must not disarm";
  EXPECT_EQ(bytes[2], 'V');
  EXPECT_EQ(watchdog.failures(), 0U);
  watchdog.stroke();
  EXPECT_EQ(watchdog.failures(), 1U);
}

TEST(DeviceWatchdog, GivenNoDeviceThenItSaysSo) {
  DeviceWatchdog watchdog;
  EXPECT_EQ(watchdog.open("/no/such/watchdog"), Status::io_error);
}

TEST(FileDescriptor, WhenMovedThenItIsClosedOnce) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  FileDescriptor a{ends[0]};
  FileDescriptor b{ends[1]};
  b = std::move(a);
  EXPECT_EQ(b.get(), ends[0]);
  EXPECT_FALSE(a.is_open());  // NOLINT(bugprone-use-after-move): the moved-from state is the point
  char byte = 0;
  EXPECT_EQ(::read(b.get(), &byte, 1), 0) << "the writing end was closed";
  const FileDescriptor c{std::move(b)};
  EXPECT_TRUE(c.is_open());
}

}  // namespace
}  // namespace picolo
