// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// WitMotion frames carry no sequence number and no common stamp: this finds out which of them were
/// sampled together.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/witmotion/witmotion_frame.hpp"
#include "picolo/sensing/imu_sample.hpp"

namespace picolo::inline v0 {

struct WitMotionGroupConfig {
  /// As set in the sensor (registers 0x21 and 0x20 where it has them).
  std::uint16_t acceleration_full_scale_g = 16;
  std::uint16_t rate_full_scale_degps = 2000;
  /// A word of this magnitude or more stands at the end of its range.
  std::int16_t saturated_from = 32767;
  /// A frame that comes later than this after its place in the group belongs to another one. Longer
  /// than the jitter of the stamps, shorter than the sensor's period.
  Duration max_spread = 4ms;
  [[nodiscard]] constexpr bool valid() const {
    return acceleration_full_scale_g > 0 && rate_full_scale_degps > 0 && saturated_from > 0 &&
           max_spread > Duration{0};
  }
};

/// Roll, pitch, yaw as the sensor's own filter sees them.
struct WitMotionAngles {
  Timestamp stamp{};
  std::array<float, 3> angles_rad{};
};

/// Never reset.
struct WitMotionGroupCounters {
  std::uint32_t samples = 0;
  std::uint32_t incomplete = 0;  ///< groups with only one of acceleration and rate
  std::uint32_t saturated = 0;   ///< samples with an axis at the end of its range
};

/// A group opens with the first enabled type: with any frame whose type is not above its
/// predecessor's, or that comes too late.
/// Cost: O(1). Context: one at a time.
class WitMotionGroup {
 public:
  explicit WitMotionGroup(const WitMotionGroupConfig& config = {});

  /// `first_bit`: when the frame began on the wire; `frame_time`: how long it took. Returns the
  /// sample that this frame completes, stamped with the begin of its group, else `not_ready`.
  /// Stamps never decrease.
  [[nodiscard]] Result<ImuSample> add(const WitMotionFrame& frame, Timestamp first_bit,
                                      Duration frame_time, StampSource source);
  /// The last angle frame; a default one before the first.
  [[nodiscard]] const WitMotionAngles& angles() const { return angles_; }
  [[nodiscard]] const WitMotionGroupCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool opens_group(std::uint8_t type, Timestamp first_bit, Duration frame_time) const;
  void open(std::uint8_t type, Timestamp first_bit, StampSource source);
  [[nodiscard]] bool read_axes(const WitMotionFrame& frame, float scale,
                               std::array<float, 3>& axes) const;
  [[nodiscard]] Result<ImuSample> emit_if_complete();

  WitMotionGroupConfig config_;
  float acceleration_scale_mps2_;
  float rate_scale_radps_;
  ImuSample sample_{};
  WitMotionAngles angles_{};
  Timestamp last_stamp_ = Timestamp::min();
  std::uint8_t first_type_ = 0;
  std::uint8_t last_type_ = 0xFF;
  bool has_acceleration_ = false;
  bool has_rate_ = false;
  WitMotionGroupCounters counters_{};
};

}  // namespace picolo::inline v0
