// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/odrive/odrive_wheels.hpp"

#include <bit>

#include "picolo/drivers/common/wire_float.hpp"

namespace picolo::inline v0 {
namespace {

WheelCollectorConfig collector_config(const OdriveWheelsConfig& config) {
  WheelCollectorConfig collector{.wheel_count = config.wheel_count,
                                 .pair_window = config.pair_window};
  for (std::size_t i = 0; i < static_cast<std::size_t>(config.wheel_count); ++i) {
    collector.wheels[i].inverted = config.wheels[i].inverted;
    collector.wheels[i].max_counts_per_s = config.max_counts_per_s;
  }
  return collector;
}

OdriveCommand position_command(const OdriveWheelsConfig& config) {
  return config.position == OdrivePosition::counts ? OdriveCommand::encoder_count
                                                   : OdriveCommand::encoder_estimates;
}

}  // namespace

OdriveWheels::OdriveWheels(CanBus& bus, const OdriveWheelsConfig& config)
    : bus_(bus), config_(config), collector_(collector_config(config)) {}

void OdriveWheels::consume_heartbeat(std::size_t wheel, const CanFrame& frame) {
  const Result<OdriveHeartbeat> heartbeat =
      decode_odrive_heartbeat(ByteView{frame.data}.first(frame.length), config_.firmware);
  if (!heartbeat) {
    ++counters_.short_frames;
    return;
  }
  OdriveAxis& axis = axes_[wheel];
  // Who was silent may have been without power: its counter may start anew.
  if (axis.lost) { collector_.restart(wheel); }
  axis = {.heartbeat = *heartbeat, .last_heard = frame.stamp, .heard = true};
}

void OdriveWheels::consume_position(std::size_t wheel, const CanFrame& frame) {
  const ByteView data = ByteView{frame.data}.first(frame.length);
  std::int64_t position = 0;
  if (config_.position == OdrivePosition::counts) {
    const Result<OdriveCounts> counts = decode_odrive_counts(data);
    if (!counts) {
      ++counters_.short_frames;
      return;
    }
    position = counts->shadow_count;
  } else {
    const Result<OdriveFloats> floats = decode_odrive_floats(data);
    if (!floats) {
      ++counters_.short_frames;
      return;
    }
    const Result<std::int64_t> ticks = scaled_integer(floats->first_bits, config_.counts_per_turn);
    if (!ticks || !float_from_bits(floats->second_bits)) {
      ++counters_.damaged;
      return;
    }
    // Only differences count: 32 bits of them are enough.
    position = std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(*ticks));
  }
  collector_.position(wheel, frame.stamp, frame.source, position);
}

bool OdriveWheels::consume(const CanFrame& frame) {
  for (std::size_t wheel = 0; wheel < wheels() && !frame.extended && !frame.remote; ++wheel) {
    const std::uint32_t node = config_.wheels[wheel].node;
    const bool heartbeat = frame.id == odrive_id(node, OdriveCommand::heartbeat);
    if (!heartbeat && frame.id != odrive_id(node, position_command(config_))) { continue; }
    ++counters_.frames;
    if (heartbeat) {
      consume_heartbeat(wheel, frame);
    } else {
      consume_position(wheel, frame);
    }
    return true;
  }
  ++counters_.foreign;
  return false;
}

Status OdriveWheels::service(Timestamp now) {
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    OdriveAxis& axis = axes_[wheel];
    if (!axis.heard || axis.lost || now - axis.last_heard <= config_.heartbeat_timeout) {
      continue;
    }
    axis.lost = true;
    ++counters_.losses;
  }
  if (config_.position != OdrivePosition::counts || now < next_request_) { return Status::ok; }
  next_request_ = now + config_.request_period;
  Status result = Status::ok;
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    const Status status =
        bus_.transmit(odrive_request(config_.wheels[wheel].node, OdriveCommand::encoder_count));
    ++(is_ok(status) ? counters_.requests : counters_.tx_refused);
    if (!is_ok(status)) { result = status; }
  }
  return result;
}

bool OdriveWheels::healthy() const {
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    const OdriveAxis& axis = axes_[wheel];
    if (!axis.heard || axis.lost || axis.heartbeat.faulted()) { return false; }
  }
  return true;
}

CanWheelsCounters OdriveWheels::counters() const {
  CanWheelsCounters counters = counters_;
  collector_.add_to(counters);
  return counters;
}

OdriveWheels::Filters OdriveWheels::filters() const {
  Filters filters;
  for (std::size_t wheel = 0; wheel < wheels(); ++wheel) {
    const std::uint32_t node = config_.wheels[wheel].node;
    static_cast<void>(filters.push_back({.id = odrive_id(node, OdriveCommand::heartbeat)}));
    static_cast<void>(filters.push_back({.id = odrive_id(node, position_command(config_))}));
  }
  return filters;
}

}  // namespace picolo::inline v0
