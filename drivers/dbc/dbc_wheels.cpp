// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/dbc/dbc_wheels.hpp"

#include <bit>

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kMaxStepQ8 = 1 << 30;
constexpr std::int64_t kOneTickQ8 = 256;

WheelCollectorConfig collector_config(const DbcWheelsConfig& config) {
  WheelCollectorConfig collector{.wheel_count = config.wheel_count,
                                 .pair_window = config.pair_window};
  for (std::size_t i = 0; i < static_cast<std::size_t>(config.wheel_count); ++i) {
    collector.wheels[i] = config.wheels[i].counter;
    if (config.wheels[i].quantity == DbcQuantity::speed) {
      collector.wheels[i].modulus = std::uint64_t{1} << 32;
      collector.wheels[i].max_counts_per_s = 0;
    }
  }
  return collector;
}

}  // namespace

DbcWheels::DbcWheels(const DbcWheelsConfig& config)
    : config_(config), collector_(collector_config(config)) {}

void DbcWheels::note_counter(std::size_t wheel, ByteView data) {
  const DbcSignal& signal = config_.wheels[wheel].rules.counter;
  if (signal.length == 0) { return; }
  const auto now = static_cast<std::uint32_t>(dbc_raw(signal, data).value_or(0));
  Progress& progress = progress_[wheel];
  const std::uint32_t mask = (1U << signal.length) - 1U;
  const std::uint32_t step = (now - progress.last_counter) & mask;
  if (progress.started && step > 1) { counters_.missed += step - 1; }
  progress.last_counter = now;
}

void DbcWheels::add_speed(std::size_t wheel, const CanFrame& frame, float speed) {
  const DbcWheelConfig& config = config_.wheels[wheel];
  Progress& progress = progress_[wheel];
  const Duration step = frame.stamp - progress.last_stamp;
  if (progress.started && step > Duration{0} && step <= config_.max_silence) {
    const float rate = (speed * config.factor + config.offset) * config.ticks_per_unit;
    const float ticks_q8 = rate * to_seconds(step) * static_cast<float>(kOneTickQ8);
    progress.ticks_q8 += round_to_i32(ticks_q8, -kMaxStepQ8, kMaxStepQ8);
  }
  const std::int64_t ticks = progress.ticks_q8 / kOneTickQ8;
  collector_.position(wheel, frame.stamp, frame.source,
                      std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(ticks)));
}

/// Length, checksum and counter belong to the frame, not to the wheels in it.
bool DbcWheels::accept(std::size_t wheel, const CanFrame& frame) {
  const DbcWheelConfig& config = config_.wheels[wheel];
  const ByteView data = ByteView{frame.data}.first(frame.length);
  if (data.size() < config.frame_bytes) {
    ++counters_.short_frames;
    return false;
  }
  if (!is_ok(dbc_check(config.rules, frame.id, data))) {
    ++counters_.damaged;
    return false;
  }
  note_counter(wheel, data);
  return true;
}

void DbcWheels::decode(std::size_t wheel, const CanFrame& frame) {
  const DbcWheelConfig& config = config_.wheels[wheel];
  const ByteView data = ByteView{frame.data}.first(frame.length);
  const DbcMultiplexer& multiplexer = config.multiplexer;
  if (multiplexer.used &&
      dbc_raw(multiplexer.selector, data).value_or(~multiplexer.value) != multiplexer.value) {
    return;
  }
  if (config.quantity == DbcQuantity::speed) {
    const Result<float> speed = dbc_number(config.signal, data);
    if (speed) {
      add_speed(wheel, frame, *speed);
    } else {
      ++counters_.damaged;
    }
  } else {
    const Result<std::int64_t> position = dbc_integer(config.signal, data);
    if (position) {
      collector_.position(wheel, frame.stamp, frame.source, *position);
    } else {
      ++counters_.damaged;
    }
  }
  progress_[wheel].last_stamp = frame.stamp;
  progress_[wheel].started = true;
}

bool DbcWheels::consume(const CanFrame& frame) {
  bool ours = false;
  for (std::size_t wheel = 0; wheel < wheels() && !frame.remote; ++wheel) {
    const DbcWheelConfig& config = config_.wheels[wheel];
    if (frame.id != config.id || frame.extended != config.extended) { continue; }
    if (!ours && !accept(wheel, frame)) {
      ++counters_.frames;
      return true;
    }
    ours = true;
    decode(wheel, frame);
  }
  ++(ours ? counters_.frames : counters_.foreign);
  return ours;
}

CanWheelsCounters DbcWheels::counters() const {
  CanWheelsCounters counters = counters_;
  collector_.add_to(counters);
  return counters;
}

DbcWheels::Filters DbcWheels::filters() const {
  Filters filters;
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    const DbcWheelConfig& config = config_.wheels[wheel];
    const CanFilter filter{.id = config.id,
                           .mask = config.extended ? 0x1FFFFFFFU : 0x7FFU,
                           .extended = config.extended};
    bool known = false;
    for (const CanFilter& other : filters) { known = known || overlap(filter, other); }
    if (!known) { static_cast<void>(filters.push_back(filter)); }
  }
  return filters;
}

}  // namespace picolo::inline v0
