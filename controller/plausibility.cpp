// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/plausibility.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int64_t kMicrosPerSecond = 1'000'000;
constexpr std::int64_t kMaxCountsPerSecond = 1'000'000'000;
constexpr std::int64_t kMaxElapsed_us =
    1'000'000'000;                        // the product of both stays inside of 64 bits
constexpr std::int64_t kSlackCounts = 2;  // of sampling
constexpr Duration kLongestStep = 50ms;   // between samples; beyond it a stream has fallen silent

}  // namespace

WheelGate::WheelGate(const PlausibilityConfig& config, const EncoderScale& encoders)
    : max_in_a_row_(config.max_left_out) {
  for (std::size_t i = 0; i < max_counts_per_s_.size(); ++i) {
    max_counts_per_s_[i] =
        round_to_i64(static_cast<double>(config.max_wheel_speed_mps) * encoders.counts_per_m[i], 0,
                     kMaxCountsPerSecond);
  }
}

std::uint8_t WheelGate::unbelievable(const WheelTicks& ticks) const {
  unsigned wheels = 0;
  const std::int64_t elapsed_us = std::min((ticks.stamp - last_.stamp).count(), kMaxElapsed_us);
  for (std::size_t i = 0; i < max_counts_per_s_.size(); ++i) {
    if (max_counts_per_s_[i] == 0) { continue; }
    const std::int64_t counts = ticks.ticks[i] - last_.ticks[i];
    const std::int64_t reach = max_counts_per_s_[i] * elapsed_us / kMicrosPerSecond + kSlackCounts;
    if (counts > reach || counts < -reach) { wheels |= 1U << i; }
  }
  return static_cast<std::uint8_t>(wheels);
}

bool WheelGate::pass(WheelTicks& ticks) {
  const bool stale = has_last_ && ticks.stamp <= last_.stamp;  // the odometry counts and ignores it
  if (stale) { return true; }
  suspects_ = has_last_ && !ticks.restarted ? unbelievable(ticks) : std::uint8_t{0};
  if (suspects_ != 0) {
    if (in_a_row_ < max_in_a_row_) {
      ++in_a_row_;
      ++left_out_;
      return false;
    }
    ticks.restarted = true;
  }
  in_a_row_ = 0;
  last_ = ticks;
  has_last_ = true;
  return true;
}

void TurnCheck::add_gyro(Timestamp stamp, float rate_radps) {
  const Duration step = stamp - last_gyro_;
  if (has_gyro_ && step > Duration{0} && step <= kLongestStep) {
    gyro_turn_rad_ += to_seconds(step) * (gyro_radps_ + rate_radps) / 2.0F;
  }
  has_gyro_ = true;
  last_gyro_ = stamp;
  gyro_radps_ = rate_radps;
}

void TurnCheck::add(const WheelIncrement& increment) {
  const Duration step = increment.to - increment.from;
  const float gyro_turn_rad = gyro_turn_rad_;
  gyro_turn_rad_ = 0.0F;
  const bool gyro_speaks = has_gyro_ && increment.to - last_gyro_ <= kLongestStep;
  if (!gyro_speaks || step > kLongestStep) {
    difference_rad_ = 0.0F;
    disagrees_ = false;
    return;
  }
  const float kept = std::max(0.0F, 1.0F - to_seconds(step) / to_seconds(config_.turn_memory));
  const auto wheel_turn_rad = static_cast<float>(increment.from_T_to.theta_rad);
  difference_rad_ = difference_rad_ * kept + (wheel_turn_rad - gyro_turn_rad);
  // Two clocks that are apart by this much show a turn both agree on as a difference.
  const float common_radps =
      std::min(magnitude(gyro_radps_), magnitude(wheel_turn_rad / to_seconds(step)));
  const float limit_rad =
      config_.max_turn_difference_rad + common_radps * to_seconds(config_.max_stamp_error);
  disagrees_ = magnitude(difference_rad_) > limit_rad;
}

}  // namespace picolo::inline v0
