// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/wheel_counter.hpp"

#include <algorithm>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int64_t kMicrosPerSecond = 1'000'000;
constexpr Duration kStampJitter = 50ms;      // frames read in one go carry nearly the same stamp
constexpr Duration kLongestSilence = 1000s;  // keeps counts times microseconds inside of 64 bits

/// Counts the wheel can have turned in this time, times a million.
std::int64_t reach(std::uint32_t counts_per_s, Duration time) {
  return static_cast<std::int64_t>(counts_per_s) * std::min(time, kLongestSilence).count();
}

}  // namespace

bool WheelCounter::believable(std::int64_t step, Duration silence) const {
  if (config_.max_counts_per_s == 0) { return true; }
  const std::int64_t distance = step < 0 ? -step : step;
  return distance * kMicrosPerSecond <= reach(config_.max_counts_per_s, silence + kStampJitter);
}

bool WheelCounter::ambiguous(Duration silence) const {
  if (config_.max_counts_per_s == 0) {
    return config_.modulus < (std::uint64_t{1} << 32) && silence > config_.max_silence;
  }
  const auto half = static_cast<std::int64_t>(config_.modulus / 2);
  return reach(config_.max_counts_per_s, silence) >= half * kMicrosPerSecond;
}

WheelCounter::Step WheelCounter::update(Timestamp stamp, std::int64_t position) {
  const auto range = static_cast<std::int64_t>(config_.modulus);
  if (position < -range || position >= range) { return Step::out_of_range; }
  const auto now = static_cast<std::uint32_t>(position < 0 ? position + range : position);
  const Duration silence = std::max(stamp - last_stamp_, Duration{0});
  const std::int64_t step = wrapped_difference(now, last_position_, config_.modulus);
  const bool had_base = has_base_;
  has_base_ = true;
  last_stamp_ = stamp;
  last_position_ = now;
  if (!had_base || ambiguous(silence)) { return Step::rebased; }
  if (!believable(step, silence)) { return Step::jumped; }
  ticks_ += config_.inverted ? -step : step;
  return Step::moved;
}

}  // namespace picolo::inline v0
