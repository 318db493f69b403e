// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Processor time of the calling thread: other work on the machine does not count.
#pragma once

#include <time.h>  // NOLINT(modernize-deprecated-headers): clock_gettime is POSIX

#include <cstdint>

#include "picolo/hal/clock.hpp"

namespace picolo::tool {

[[nodiscard]] inline double processor_time_us() {
  timespec now{};
  static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now));
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// The same in nanoseconds, for the executive.
class ProcessorTimeCounter final : public CycleCounter {
 public:
  std::uint32_t cycles() override {
    timespec now{};
    static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now));
    return static_cast<std::uint32_t>(now.tv_sec * 1'000'000'000LL + now.tv_nsec);
  }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1000; }
};

}  // namespace picolo::tool
