// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06_timeline.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int64_t kIntervals = kLd06PointsPerPacket - 1;

}  // namespace

void Ld06Timeline::stamp(Timestamp first_bit, std::uint16_t timestamp_ms,
                         std::span<RangeReading, kLd06PointsPerPacket> readings) {
  const Timestamp sent =
      config_.use_device_clock ? clock_.map(first_bit, Duration{timestamp_ms * 1000}) : first_bit;
  const Timestamp end = sent - config_.latency;
  const auto rate = static_cast<std::int64_t>(config_.points_per_second);
  const Timestamp begin = end - Duration{kIntervals * 1'000'000 / rate};
  const bool overlaps = last_ != Timestamp::min() && begin < last_ + Duration{1'000'000 / rate};

  for (std::size_t i = 0; i < kLd06PointsPerPacket; ++i) {
    const auto index = static_cast<std::int64_t>(i);
    if (!overlaps) {
      readings[i].stamp = end - Duration{(kIntervals - index) * 1'000'000 / rate};
    } else if (end > last_) {
      readings[i].stamp =
          last_ + (end - last_) * (index + 1) / static_cast<std::int64_t>(kLd06PointsPerPacket);
    } else {
      readings[i].stamp = last_;
    }
  }
  last_ = readings[kLd06PointsPerPacket - 1].stamp;
}

}  // namespace picolo::inline v0
