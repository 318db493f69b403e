// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Finds sensors whose axes are dead while everything else looks alive.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/sensing/imu_sample.hpp"

namespace picolo::inline v0 {

struct AxisWatchConfig {
  /// A group of axes that repeats the same bits for this long is stuck. Noise moves the last bit of
  /// a living sensor many times a second.
  Duration patience = 2s;
  [[nodiscard]] constexpr bool valid() const { return patience > Duration{0}; }
};

/// Looks at the values, not at the bytes: counters, temperature and checksums go on changing in
/// frames whose gyro is stuck. The gyro counts as stuck only while the accelerometer moves: some
/// sensors report an exact zero at rest. Cost: O(1). Context: one at a time.
class AxisWatch {
 public:
  explicit AxisWatch(const AxisWatchConfig& config = {}) : config_(config) {}

  void update(const ImuSample& sample);
  [[nodiscard]] bool gyro_stuck() const { return gyro_stuck_; }
  [[nodiscard]] bool accelerometer_stuck() const { return accelerometer_stuck_; }
  /// How often either began; never reset.
  [[nodiscard]] std::uint32_t events() const { return events_; }

 private:
  AxisWatchConfig config_;
  ImuSample last_{};
  Timestamp gyro_changed_{};
  Timestamp accelerometer_changed_{};
  std::uint32_t accelerations_ = 0;  ///< changes since the gyro's last one
  bool started_ = false;
  bool gyro_stuck_ = false;
  bool accelerometer_stuck_ = false;
  std::uint32_t events_ = 0;
};

}  // namespace picolo::inline v0
