// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sensing/sweep.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

SweepAssemblerCore::SweepAssemblerCore(const SweepAssemblerConfig& config,
                                       std::span<RangeReturn> first, std::span<RangeReturn> second)
    : config_(config), buffers_{first, second} {}

void SweepAssemblerCore::begin(const RangeReading& reading) {
  in_sweep_ = true;
  dropped_ = false;
  size_ = 0;
  sweeps_[filling_].stamp = reading.stamp;
}

void SweepAssemblerCore::complete() {
  if (size_ < static_cast<std::size_t>(config_.min_readings)) {
    ++counters_.partial;
    return;
  }
  if (ready_) { ++counters_.replaced; }
  Sweep& sweep = sweeps_[filling_];
  sweep.sequence = counters_.completed;
  sweep.returns = buffers_[filling_].first(size_);
  ++counters_.completed;
  ready_ = true;
  filling_ = 1 - filling_;
}

void SweepAssemblerCore::drop() {
  if (!dropped_) { ++counters_.partial; }
  dropped_ = true;
  in_sweep_ = false;
}

void SweepAssemblerCore::add(const RangeReading& reading) {
  if (in_sweep_) {
    const Duration since_last = reading.stamp - last_stamp_;
    if (since_last < Duration{0}) { ++counters_.out_of_order; }
    // A clock that was set back would otherwise make every later reading out of order.
    if (since_last > config_.max_gap || since_last < -config_.max_gap) { drop(); }
    if (in_sweep_ && since_last < Duration{0} && !reading.starts_sweep) { return; }
  }
  if (reading.starts_sweep) {
    if (in_sweep_) { complete(); }
    begin(reading);
  }
  if (!in_sweep_) {
    drop();
    return;
  }
  last_stamp_ = reading.stamp;
  store(reading);
  if (reading.ends_sweep) {
    complete();
    in_sweep_ = false;
  }
}

void SweepAssemblerCore::store(const RangeReading& reading) {
  if (size_ == buffers_[filling_].size()) {
    ++counters_.overflowed;
    return;
  }
  Sweep& sweep = sweeps_[filling_];
  buffers_[filling_][size_] = {reading.range_m, reading.bearing_rad,
                               to_seconds(reading.stamp - sweep.stamp)};
  sweep.last_stamp = reading.stamp;
  ++size_;
}

Sweep SweepAssemblerCore::take() {
  ready_ = false;
  return sweeps_[1 - filling_];
}

}  // namespace picolo::inline v0
