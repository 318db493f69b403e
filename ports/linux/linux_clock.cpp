// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/linux_clock.hpp"

#include <time.h>

namespace picolo::inline v0 {

Timestamp LinuxClock::now() {
  timespec time{};
  static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &time));
  return Timestamp{Duration{std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000}};
}

std::uint32_t LinuxCycleCounter::cycles() {
  timespec time{};
  static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &time));
  const auto nanoseconds = static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U +
                           static_cast<std::uint64_t>(time.tv_nsec);
  return static_cast<std::uint32_t>(nanoseconds & 0xFFFF'FFFFU);
}

Status sleep_until(Timestamp wake) {
  const std::int64_t microseconds = wake.time_since_epoch().count();
  if (microseconds < 0) { return Status::ok; }
  timespec time{};
  time.tv_sec = static_cast<time_t>(microseconds / 1'000'000);
  time.tv_nsec = static_cast<long>(microseconds % 1'000'000 * 1000);
  const int error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
  return error == 0 ? Status::ok : Status::not_ready;
}

}  // namespace picolo::inline v0
