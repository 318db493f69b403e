// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/sample_timeline.hpp"

namespace picolo::inline v0 {

void SampleTimeline::stamp(Timestamp end, std::span<RangeReading> readings) {
  if (readings.empty()) { return; }
  const auto rate = static_cast<std::int64_t>(points_per_second_);
  const auto count = static_cast<std::int64_t>(readings.size());
  const Timestamp begin = end - Duration{(count - 1) * 1'000'000 / rate};
  const bool overlaps = last_ != Timestamp::min() && begin < last_ + Duration{1'000'000 / rate};
  std::int64_t index = 0;
  for (RangeReading& reading : readings) {
    if (!overlaps) {
      reading.stamp = end - Duration{(count - 1 - index) * 1'000'000 / rate};
    } else if (end > last_) {
      reading.stamp = last_ + (end - last_) * (index + 1) / count;
    } else {
      reading.stamp = last_;
    }
    ++index;
  }
  last_ = readings.back().stamp;
}

}  // namespace picolo::inline v0
