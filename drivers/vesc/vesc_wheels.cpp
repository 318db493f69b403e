// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/vesc/vesc_wheels.hpp"

namespace picolo::inline v0 {
namespace {

WheelCollectorConfig collector_config(const VescWheelsConfig& config) {
  WheelCollectorConfig collector{.wheel_count = config.wheel_count,
                                 .pair_window = config.pair_window};
  for (std::size_t i = 0; i < static_cast<std::size_t>(config.wheel_count); ++i) {
    collector.wheels[i].inverted = config.wheels[i].inverted;
    collector.wheels[i].max_counts_per_s = config.max_erpm / 10;  // six counts, sixty seconds
  }
  return collector;
}

}  // namespace

VescWheels::VescWheels(const VescWheelsConfig& config)
    : config_(config), collector_(collector_config(config)) {}

bool VescWheels::consume(const CanFrame& frame) {
  for (std::size_t wheel = 0; wheel < wheels() && frame.extended && !frame.remote; ++wheel) {
    const std::uint8_t vesc = config_.wheels[wheel].vesc;
    const bool speed = frame.id == vesc_id(vesc, VescCommand::status);
    if (!speed && frame.id != vesc_id(vesc, VescCommand::status_5)) { continue; }
    ++counters_.frames;
    const ByteView data = ByteView{frame.data}.first(frame.length);
    if (speed) {
      const Result<VescStatus> status = decode_vesc_status(data);
      counters_.short_frames += status ? 0U : 1U;
      if (status) { erpm_[wheel] = status->erpm; }
      return true;
    }
    const Result<VescStatus5> status = decode_vesc_status_5(data);
    if (!status) {
      ++counters_.short_frames;
      return true;
    }
    if (lost_[wheel]) { collector_.restart(wheel); }
    lost_[wheel] = false;
    alive_[wheel] = true;
    last_heard_[wheel] = frame.stamp;
    collector_.position(wheel, frame.stamp, frame.source, status->tachometer);
    return true;
  }
  ++counters_.foreign;
  return false;
}

Status VescWheels::service(Timestamp now) {
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    if (!alive_[wheel] || now - last_heard_[wheel] <= config_.timeout) { continue; }
    alive_[wheel] = false;
    lost_[wheel] = true;
    ++counters_.losses;
  }
  return Status::ok;
}

bool VescWheels::healthy() const {
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    if (!alive_[wheel]) { return false; }
  }
  return true;
}

CanWheelsCounters VescWheels::counters() const {
  CanWheelsCounters counters = counters_;
  collector_.add_to(counters);
  return counters;
}

VescWheels::Filters VescWheels::filters() const {
  constexpr std::uint32_t kAllBits = 0x1FFFFFFF;
  Filters filters;
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    const std::uint8_t vesc = config_.wheels[wheel].vesc;
    for (const VescCommand command : {VescCommand::status, VescCommand::status_5}) {
      static_cast<void>(
          filters.push_back({.id = vesc_id(vesc, command), .mask = kAllBits, .extended = true}));
    }
  }
  return filters;
}

}  // namespace picolo::inline v0
