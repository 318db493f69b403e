// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// When each point of a lidar's packet was measured.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

/// Points are equally spaced in time and never run backwards, whatever the stamps of the packets
/// do: a packet that seems to overlap its predecessor is squeezed behind it. Cost: O(points).
/// Context: one at a time.
class SampleTimeline {
 public:
  /// Precondition: points_per_second > 0.
  explicit SampleTimeline(std::uint32_t points_per_second)
      : points_per_second_(points_per_second) {}

  /// `end`: when the last of the readings was measured. Writes the stamps of all.
  void stamp(Timestamp end, std::span<RangeReading> readings);
  [[nodiscard]] Timestamp last_stamp() const { return last_; }

 private:
  std::uint32_t points_per_second_;
  Timestamp last_ = Timestamp::min();
};

}  // namespace picolo::inline v0
