// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/witmotion/witmotion_group.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kStandardGravity_mps2 = 9.80665F;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kWordRange = 32768.0F;

}  // namespace

WitMotionGroup::WitMotionGroup(const WitMotionGroupConfig& config)
    : config_(config),
      acceleration_scale_mps2_(static_cast<float>(config.acceleration_full_scale_g) *
                               kStandardGravity_mps2 / kWordRange),
      rate_scale_radps_(static_cast<float>(config.rate_full_scale_degps) * kPi / 180.0F /
                        kWordRange) {}

bool WitMotionGroup::opens_group(std::uint8_t type, Timestamp first_bit,
                                 Duration frame_time) const {
  if (type <= last_type_) { return true; }
  // Frames of a group follow one another; types that are switched off only bring the others nearer.
  const Timestamp latest = sample_.stamp + (type - first_type_) * frame_time + config_.max_spread;
  return first_bit > latest;
}

void WitMotionGroup::open(std::uint8_t type, Timestamp first_bit, StampSource source) {
  if (has_acceleration_ != has_rate_) { ++counters_.incomplete; }
  has_acceleration_ = false;
  has_rate_ = false;
  first_type_ = type;
  sample_ = {.stamp = std::max(first_bit, last_stamp_), .source = source};
}

bool WitMotionGroup::read_axes(const WitMotionFrame& frame, float scale,
                               std::array<float, 3>& axes) const {
  bool saturated = false;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::int16_t word = frame.words[i];
    saturated = saturated || word >= config_.saturated_from || word <= -config_.saturated_from;
    axes[i] = static_cast<float>(word) * scale;
  }
  return saturated;
}

Result<ImuSample> WitMotionGroup::emit_if_complete() {
  if (!has_acceleration_ || !has_rate_) { return Status::not_ready; }
  ++counters_.samples;
  if (sample_.saturated) { ++counters_.saturated; }
  last_stamp_ = sample_.stamp;
  return sample_;
}

Result<ImuSample> WitMotionGroup::add(const WitMotionFrame& frame, Timestamp first_bit,
                                      Duration frame_time, StampSource source) {
  const auto type = static_cast<std::uint8_t>(frame.type);
  if (opens_group(type, first_bit, frame_time)) { open(type, first_bit, source); }
  last_type_ = type;
  if (frame.type == WitMotionType::acceleration) {
    const bool saturated = read_axes(frame, acceleration_scale_mps2_, sample_.acceleration_mps2);
    sample_.saturated = sample_.saturated || saturated;
    has_acceleration_ = true;
    return emit_if_complete();
  }
  if (frame.type == WitMotionType::rate) {
    const bool saturated = read_axes(frame, rate_scale_radps_, sample_.rate_radps);
    sample_.saturated = sample_.saturated || saturated;
    has_rate_ = true;
    return emit_if_complete();
  }
  if (frame.type == WitMotionType::angle) {
    angles_.stamp = sample_.stamp;
    for (std::size_t i = 0; i < angles_.angles_rad.size(); ++i) {
      angles_.angles_rad[i] = static_cast<float>(frame.words[i]) / kWordRange * kPi;
    }
  }
  return Status::not_ready;
}

}  // namespace picolo::inline v0
