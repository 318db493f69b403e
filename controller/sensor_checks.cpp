// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/sensor_checks.hpp"

#include <algorithm>
#include <bit>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr Duration kLongestStep = 50ms;  // between samples; beyond it nothing is compared
constexpr float kSlackCounts = 3.0F;     // of sampling, twice, and one for the drive's own noise
constexpr float kMean_s = 0.4F;          // memory of the accelerometer's mean
constexpr std::uint16_t kUpright = 50;   // samples that say what upright is
constexpr std::uint32_t kPrime = 16'777'619U;
constexpr std::uint16_t kFewReturns = 30;  // fewer prove nothing
constexpr float kGravity_mps2 = 9.81F;

float dot(const Axes& a, const Axes& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

WheelStepCheck::WheelStepCheck(const PlausibilityConfig& config, const EncoderScale& encoders)
    : max_acceleration_mps2_(config.max_wheel_acceleration_mps2),
      stamp_jitter_s_(to_seconds(config.max_stamp_jitter)) {
  for (std::size_t i = 0; i < counts_per_m_.size(); ++i) {
    counts_per_m_[i] = static_cast<float>(encoders.counts_per_m[i]);
  }
}

std::uint8_t WheelStepCheck::add(const WheelTicks& ticks) {
  const Duration step = ticks.stamp - last_.stamp;
  if (has_last_ && step <= Duration{0}) { return 0; }
  const bool comparable = has_last_ && !ticks.restarted && step <= kLongestStep;
  const float step_s = to_seconds(step);
  unsigned doubts = 0;
  for (std::size_t i = 0; comparable && i < counts_per_m_.size(); ++i) {
    const auto counts = static_cast<float>(ticks.ticks[i] - last_.ticks[i]);
    const float before = rate_counts_per_s_[i];
    rate_counts_per_s_[i] = counts / step_s;
    if (!has_rate_ || counts_per_m_[i] == 0.0F) { continue; }
    const float faster = std::max(magnitude(before), magnitude(rate_counts_per_s_[i]));
    const float limit = max_acceleration_mps2_ * counts_per_m_[i] * step_s * step_s + kSlackCounts +
                        2.0F * stamp_jitter_s_ * faster;
    if (magnitude(counts - before * step_s) > limit) { doubts |= 1U << i; }
  }
  has_rate_ = comparable;
  has_last_ = true;
  last_ = ticks;
  return static_cast<std::uint8_t>(doubts);
}

Duration AxesStream::add(Timestamp stamp, const Axes& axes, bool moving) {
  const bool repeats = started_ && axes == newest_ && stamp - stamp_ <= kLongestStep;
  if (!repeats || !moving) { changed_ = stamp; }
  stamp_ = stamp;
  newest_ = axes;
  started_ = true;
  return stamp - changed_;
}

bool GyroCheck::add(const ImuSample& sample, bool moving, float turn_difference_rad) {
  const Duration step = sample.stamp - rate_radps_.stamp();
  if (rate_radps_.started() && step <= Duration{0}) { return false; }
  const float leap_radps = magnitude(sample.rate_radps[2] - rate_radps_.newest()[2]);
  const bool leaps = rate_radps_.started() && step <= kLongestStep &&
                     leap_radps > config_.max_gyro_leap_radps +
                                      config_.max_turn_acceleration_radps2 * to_seconds(step);
  const Duration repeats = rate_radps_.add(sample.stamp, sample.rate_radps, moving);
  const bool stuck = repeats >= config_.max_repetition &&
                     magnitude(turn_difference_rad) > config_.max_stuck_turn_rad;
  return leaps || stuck;
}

void SweepCheck::compare() {
  if (hash_ == kNothing) { return; }  // compared already: the revolution told its end
  repeats_ = returns_ >= kFewReturns && hash_ == last_hash_;
  // The single readings that end a revolution of some lidars are none.
  if (returns_ > 0) { last_hash_ = hash_; }
  hash_ = kNothing;
  returns_ = 0;
}

void SweepCheck::add(const RangeReading& reading) {
  if (reading.starts_sweep) { compare(); }
  hash_ = (hash_ ^ std::bit_cast<std::uint32_t>(reading.range_m)) * kPrime;
  if (reading.range_m > 0.0F && returns_ < kFewReturns) { ++returns_; }
  if (reading.ends_sweep) { compare(); }
}

void GravityCheck::add(const ImuSample& sample, bool moving) {
  const Axes& now = sample.acceleration_mps2;
  const bool first = !acceleration_mps2_.started();
  const Duration step = sample.stamp - acceleration_mps2_.stamp();
  if (!first && step <= Duration{0}) { return; }
  const Duration repeats = acceleration_mps2_.add(sample.stamp, now, moving);
  if (first) { mean_ = now; }
  const float share = std::min(1.0F, to_seconds(step) / kMean_s);
  Axes off{};
  for (std::size_t axis = 0; axis < off.size(); ++axis) {
    off[axis] = now[axis] - mean_[axis];
    if (!first) { mean_[axis] += share * off[axis]; }
  }
  if (!first) { variance_ += share * (dot(off, off) - variance_); }

  shaken_ = dot(off, off) > config_.max_shaking_mps2 * config_.max_shaking_mps2;
  const float squared = dot(mean_, mean_);
  const float least = kGravity_mps2 * (1.0F - config_.max_gravity_error);
  const float most = kGravity_mps2 * (1.0F + config_.max_gravity_error);
  doubtful_ = repeats >= config_.max_repetition || squared < least * least ||
              squared > most * most ||
              variance_ > config_.max_vibration_mps2 * config_.max_vibration_mps2;
  if (!moving && upright_samples_ < kUpright && !doubtful_ && !shaken_) {
    ++upright_samples_;
    for (std::size_t axis = 0; axis < upright_.size(); ++axis) {
      upright_[axis] += (now[axis] - upright_[axis]) / static_cast<float>(upright_samples_);
    }
  }
  const float along = dot(mean_, upright_);
  const float cosine = config_.max_tilt_cosine;
  tilted_ = upright_samples_ == kUpright && !doubtful_ &&
            (along < 0.0F || along * along < cosine * cosine * squared * dot(upright_, upright_));
}

}  // namespace picolo::inline v0
