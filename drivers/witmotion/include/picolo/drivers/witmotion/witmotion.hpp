// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// WitMotion inertial sensors on a serial line (9600 baud from the factory, 115200 and more once
/// set).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/drivers/witmotion/witmotion_frame.hpp"
#include "picolo/drivers/witmotion/witmotion_group.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/sensing/imu_sample.hpp"

namespace picolo::inline v0 {

struct WitMotionConfig {
  WitMotionGroupConfig group{};
  [[nodiscard]] constexpr bool valid() const { return group.valid(); }
};

/// Never reset.
struct WitMotionCounters {
  std::uint32_t bytes = 0;
  std::uint32_t frames = 0;
  std::uint32_t bad_checksums = 0;
  std::uint32_t skipped_bytes = 0;  ///< bytes that were part of no frame
  std::uint32_t samples = 0;
  std::uint32_t incomplete = 0;  ///< groups with only one of acceleration and rate
  std::uint32_t saturated = 0;
};

/// Polling shell. Precondition: config.valid(). Context: one at a time. Memory: about 200 bytes, no
/// heap.
class WitMotion {
 public:
  explicit WitMotion(SerialPort& port, const WitMotionConfig& config = {});

  /// Reads at most `max_bytes` and writes the samples that they complete; returns how many. Reads
  /// no more bytes than `samples` has room for, so none is lost. Stamps never decrease.
  /// `not_ready`: no sample complete yet. `invalid_argument`: no room at all. `disconnected` and
  /// the like: from the port, after everything read before was handed out. Cost: O(max_bytes).
  [[nodiscard]] Result<std::size_t> poll(std::size_t max_bytes, std::span<ImuSample> samples);

  /// The last angle frame, where the sensor sends them; a default one before the first.
  [[nodiscard]] const WitMotionAngles& angles() const { return group_.angles(); }
  [[nodiscard]] WitMotionCounters counters() const;

 private:
  SerialPort& port_;
  WitMotionDecoder decoder_;
  WitMotionGroup group_;
  std::uint32_t bytes_ = 0;
};

}  // namespace picolo::inline v0
