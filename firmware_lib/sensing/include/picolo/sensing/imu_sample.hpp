// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an IMU driver delivers.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

/// Accelerations and rates in the sensor's own axes (x forward, y left, z up when mounted as
/// REP-103 asks).
struct ImuSample {
  Timestamp stamp{};  ///< when the rates were measured
  StampSource source = StampSource::read;
  bool saturated = false;                    ///< at least one axis stands at the end of its range
  std::array<float, 3> acceleration_mps2{};  ///< specific force; at rest +9.81 on z
  std::array<float, 3> rate_radps{};         ///< angular rate, right-handed
};

}  // namespace picolo::inline v0
