// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a wheel encoder driver delivers.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

inline constexpr int kMaxWheels = 4;

/// Cumulative counts of all wheels at one instant, unwrapped to 64 bits by the driver.
/// A differential drive has its left wheel at index 0 and its right wheel at index 1; positive
/// rolls forward.
struct WheelTicks {
  Timestamp stamp{};  ///< when the counters were sampled
  StampSource source = StampSource::read;
  bool restarted = false;  ///< a counter started anew: use this sample as a base, not as motion
  std::array<std::int64_t, kMaxWheels> ticks{};  ///< counts
};

}  // namespace picolo::inline v0
