// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// When each point of an LD06 packet was measured.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/drivers/common/sample_timeline.hpp"
#include "picolo/drivers/ld06/ld06_packet.hpp"
#include "picolo/sensing/device_clock.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

struct Ld06TimelineConfig {
  /// From the measurement of the last point to the first bit of the packet on the wire.
  Duration latency{0};
  std::uint32_t points_per_second = 4500;  ///< STL-06P and STL-26: 5000, STL-27L: 21600
  /// Use the device's millisecond counter to take late stamps of the host (batched reads, USB
  /// latency) back.
  bool use_device_clock = true;
  DeviceClockConfig clock{.wrap = Duration{kLd06TimestampWrapMs * 1000}, .resolution = 1ms};
  [[nodiscard]] constexpr bool valid() const {
    return latency >= Duration{0} && points_per_second > 0 && points_per_second <= 1'000'000 &&
           clock.valid();
  }
};

/// Points are equally spaced in time and never run backwards, whatever the stamps of the packets
/// do: a packet that seems to overlap its predecessor is squeezed behind it. Cost: O(points).
/// Context: one at a time.
class Ld06Timeline {
 public:
  explicit Ld06Timeline(const Ld06TimelineConfig& config = {})
      : config_(config), clock_(config.clock), timeline_(config.points_per_second) {}

  /// `first_bit`: when the packet began on the wire. Writes the stamps of all readings.
  void stamp(Timestamp first_bit, std::uint16_t timestamp_ms,
             std::span<RangeReading, kLd06PointsPerPacket> readings);
  [[nodiscard]] Timestamp last_stamp() const { return timeline_.last_stamp(); }
  [[nodiscard]] std::uint32_t clock_restarts() const { return clock_.restarts(); }

 private:
  Ld06TimelineConfig config_;
  DeviceClock clock_;
  SampleTimeline timeline_;
};

}  // namespace picolo::inline v0
