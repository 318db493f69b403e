// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/wheel_collector.hpp"

namespace picolo::inline v0 {

WheelCollector::WheelCollector(const WheelCollectorConfig& config)
    : pairing_({.wheel_count = config.wheel_count, .window = config.pair_window}) {
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    counters_[i] = WheelCounter{config.wheels[i]};
  }
}

void WheelCollector::position(std::size_t wheel, Timestamp stamp, StampSource source,
                              std::int64_t position) {
  const WheelCounter::Step step = counters_[wheel].update(stamp, position);
  if (step == WheelCounter::Step::out_of_range) {
    ++counted_.out_of_range;
    return;
  }
  if (step == WheelCounter::Step::jumped) { ++counted_.jumps; }
  const Result<WheelTicks> sample = pairing_.count(wheel, stamp, source, counters_[wheel].ticks(),
                                                   step != WheelCounter::Step::moved);
  if (!sample) { return; }
  WheelTicks newest = *sample;
  if (sample_) {
    ++counted_.replaced;
    newest.restarted = newest.restarted || sample_->restarted;
  }
  sample_ = newest;
  ++counted_.samples;
}

void WheelCollector::restart(std::size_t wheel) {
  counters_[wheel].expect_restart();
  pairing_.forget(wheel);
}

Result<WheelTicks> WheelCollector::take() {
  const Result<WheelTicks> sample = sample_;
  sample_ = Status::not_ready;
  return sample;
}

void WheelCollector::add_to(CanWheelsCounters& counters) const {
  counters.samples += counted_.samples;
  counters.replaced += counted_.replaced;
  counters.out_of_range += counted_.out_of_range;
  counters.jumps += counted_.jumps;
  counters.unpaired += pairing_.unpaired();
}

}  // namespace picolo::inline v0
