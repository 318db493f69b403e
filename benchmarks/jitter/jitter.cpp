// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// How late the minor frames of the cycle begin on this machine: SECONDS of releases every 5 ms, as
// `picolo run` makes them. benchmarks/jitter/run puts load and cyclictest beside it.

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/realtime.hpp"

namespace {

using namespace picolo;

void tell(const char* what, Status status) {
  std::printf("%-14s %s\n", what, is_ok(status) ? "yes" : std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 10;
  const int priority = argc > 2 ? std::atoi(argv[2]) : 80;
  if (seconds < 1) {
    std::fprintf(stderr, "usage: jitter [SECONDS=10] [PRIORITY=80]\n");
    return 2;
  }
  std::vector<std::int64_t> late_us;
  late_us.reserve(static_cast<std::size_t>(seconds) * 200);
  tell("mlockall", lock_memory());
  tell("SCHED_FIFO", use_fifo_priority(priority));
  tell("exact timers", use_exact_timers());
  LinuxClock clock;
  Timestamp release = clock.now() + 5ms;
  for (int frame = 0; frame < seconds * 200; ++frame) {
    (void)sleep_until(release);
    late_us.push_back((clock.now() - release).count());
    release += 5ms;
  }
  std::sort(late_us.begin(), late_us.end());
  const auto share = [&](double q) {
    return static_cast<long long>(
        late_us[static_cast<std::size_t>(q * static_cast<double>(late_us.size() - 1))]);
  };
  std::printf(
      "picolo         %zu releases, late by us: least %lld, median %lld, 99 %% %lld, "
      "99.9 %% %lld, most %lld\n",
      late_us.size(), share(0.0), share(0.5), share(0.99), share(0.999), share(1.0));
}
