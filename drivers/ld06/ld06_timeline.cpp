// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06_timeline.hpp"

namespace picolo::inline v0 {

void Ld06Timeline::stamp(Timestamp first_bit, std::uint16_t timestamp_ms,
                         std::span<RangeReading, kLd06PointsPerPacket> readings) {
  const Timestamp sent =
      config_.use_device_clock ? clock_.map(first_bit, Duration{timestamp_ms * 1000}) : first_bit;
  timeline_.stamp(sent - config_.latency, readings);
}

}  // namespace picolo::inline v0
