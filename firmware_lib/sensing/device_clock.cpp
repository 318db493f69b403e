// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sensing/device_clock.hpp"

#include <algorithm>

namespace picolo::inline v0 {

void DeviceClock::begin(Timestamp host, Duration device) {
  started_ = true;
  unwrapped_ = Duration{0};
  last_device_ = device;
  last_host_ = host;
  window_start_ = host;
  fastest_ = host;
  fastest_before_ = Timestamp::max();
}

Timestamp DeviceClock::map(Timestamp host, Duration device) {
  device %= config_.wrap;
  if (!started_) {
    begin(host, device);
    return host;
  }
  const Duration host_step = host - last_host_;
  Duration device_step = device - last_device_;
  if (device_step < Duration{0}) { device_step += config_.wrap; }
  const bool stands_still = device_step == Duration{0} && host_step > 2 * config_.resolution;
  if (stands_still || host_step > config_.wrap / 2) {
    ++restarts_;
    begin(host, device);
    return host;
  }
  unwrapped_ += device_step;
  last_device_ = device;
  last_host_ = host;

  if (host - window_start_ >= config_.window) {
    fastest_before_ = host - window_start_ < 2 * config_.window ? fastest_ : Timestamp::max();
    fastest_ = Timestamp::max();
    window_start_ = host;
  }
  fastest_ = std::min(fastest_, host - unwrapped_);

  // The counter truncates: two of its values differ by up to one step less than the time between
  // them.
  const Duration drift = 2 * config_.window * config_.max_drift_ppm / 1'000'000;
  const Timestamp latest =
      std::min(fastest_, fastest_before_) + unwrapped_ + config_.resolution + drift;
  if (host - latest > config_.max_lateness) {
    ++restarts_;
    begin(host, device);
    return host;
  }
  return std::min(host, latest);
}

}  // namespace picolo::inline v0
