// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/axis_watch.hpp"

namespace picolo::inline v0 {
namespace {

/// A living accelerometer that moves changes at least this often within the patience.
constexpr std::uint32_t kMinChanges = 20;

}  // namespace

void AxisWatch::update(const ImuSample& sample) {
  if (!started_) {
    started_ = true;
    gyro_changed_ = sample.stamp;
    accelerometer_changed_ = sample.stamp;
    last_ = sample;
    return;
  }
  if (sample.acceleration_mps2 != last_.acceleration_mps2) {
    accelerometer_changed_ = sample.stamp;
    ++accelerations_;
  }
  if (sample.rate_radps != last_.rate_radps) {
    gyro_changed_ = sample.stamp;
    accelerations_ = 0;
  }
  last_ = sample;
  const bool gyro =
      sample.stamp - gyro_changed_ >= config_.patience && accelerations_ >= kMinChanges;
  const bool accelerometer = sample.stamp - accelerometer_changed_ >= config_.patience;
  events_ += (gyro && !gyro_stuck_ ? 1U : 0U) + (accelerometer && !accelerometer_stuck_ ? 1U : 0U);
  gyro_stuck_ = gyro;
  accelerometer_stuck_ = accelerometer;
}

}  // namespace picolo::inline v0
