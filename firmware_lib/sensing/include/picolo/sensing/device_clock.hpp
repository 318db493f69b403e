// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A device that stamps its data with a clock of its own knows better than the host when it
/// measured, but not on our clock.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

struct DeviceClockConfig {
  Duration wrap = 30s;        ///< the device's counter starts again at 0 here
  Duration resolution = 1ms;  ///< of the counter
  Duration window = 500ms;    ///< the fastest delivery of one to two windows counts
  std::uint32_t max_drift_ppm = 200;
  Duration max_lateness = 200ms;  ///< a host stamp later than this against the device's clock means
                                  ///< that one of them jumped
  [[nodiscard]] constexpr bool valid() const {
    return resolution > Duration{0} && window > Duration{0} && wrap >= 4 * window &&
           max_lateness > resolution;
  }
};

/// Minimum filter over host stamp minus device stamp. A host stamp is never early, only late by the
/// time the data waited (batched reads, USB frames, a busy host); the fastest delivery of the last
/// one to two windows bounds when each later one can have been measured at the latest. The result
/// is never later than the host's stamp and, when the host's stamps are perfect, equal to it: the
/// filter can take jitter away, never add it. A counter that stands still, wraps, restarts or runs
/// at a wrong rate makes it fall back to the host.
/// Cost: O(1), integers only. Context: one at a time.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockConfig& config = {}) : config_(config) {}

  /// `host`: when the data arrived; `device`: its counter, in [0, wrap). Call in the order of
  /// arrival.
  [[nodiscard]] Timestamp map(Timestamp host, Duration device);
  /// How often the two clocks did not fit and the filter began anew; never reset.
  [[nodiscard]] std::uint32_t restarts() const { return restarts_; }

 private:
  void begin(Timestamp host, Duration device);

  DeviceClockConfig config_;
  Duration unwrapped_{};  ///< device time since `begin`, without wraps
  Duration last_device_{};
  Timestamp last_host_{};
  Timestamp window_start_{};
  Timestamp fastest_{};         ///< smallest host - unwrapped in this window
  Timestamp fastest_before_{};  ///< and in the window before
  std::uint32_t restarts_ = 0;
  bool started_ = false;
};

}  // namespace picolo::inline v0
