// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a lidar driver delivers, and what a sweep is made of.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

/// One measured beam as a driver decodes it: absolute time, sensor's own polar coordinates.
struct RangeReading {
  Timestamp stamp{};          ///< when this beam was measured
  float range_m = 0.0F;       ///< 0 when nothing came back
  float bearing_rad = 0.0F;   ///< counter-clockwise from the sensor's x axis, in [-pi, pi]
  bool starts_sweep = false;  ///< first reading of a new revolution
  bool ends_sweep = false;    ///< last one, where the device tells; else the next start does
};

/// One beam inside of a sweep. 12 bytes.
struct RangeReturn {
  float range_m = 0.0F;
  float bearing_rad = 0.0F;
  float since_sweep_start_s = 0.0F;
};

/// Which ranges are measurements. Everything else (0, NaN, infinity, outside) is kept in the sweep,
/// for its time, but never becomes a point.
struct RangeLimits {
  float min_m = 0.05F;
  float max_m = 30.0F;
  [[nodiscard]] constexpr bool valid() const { return min_m > 0.0F && max_m > min_m; }
  [[nodiscard]] constexpr bool contains(float range_m) const {
    return range_m >= min_m && range_m <= max_m;
  }
};

}  // namespace picolo::inline v0
