// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Time is a type: `Timestamp` for instants, `Duration` for differences, on one monotonic
/// microsecond clock. The only header of the library that includes <chrono>.
#pragma once

#include <chrono>
#include <cstdint>

namespace picolo::inline v0 {

/// The library's clock: 64-bit microseconds since an arbitrary start, never stepped. It has no
/// `now()`: time enters through `hal::Clock` at the edge, drivers and algorithms never read a
/// clock.
struct MonotonicClock {
  using rep = std::int64_t;
  using period = std::micro;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<MonotonicClock>;
  static constexpr bool is_steady = true;
};

using Duration = MonotonicClock::duration;
using Timestamp = MonotonicClock::time_point;

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): 5ms reads as 5ms

/// Where a stamp was taken, best first.
enum class StampSource : std::uint8_t { hardware, kernel, read, device };

/// Seconds as float, for offsets within a sweep. Exact to 1 us up to 8 s.
[[nodiscard]] float to_seconds(Duration duration);
/// Seconds as double, for logs and evaluation.
[[nodiscard]] double to_seconds_f64(Duration duration);
/// Nearest microsecond; saturates; NaN gives zero.
[[nodiscard]] Duration from_seconds(double seconds_s);

}  // namespace picolo::inline v0
