// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/canopen_wheels.hpp"

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/canopen/cob_id.hpp"
#include "picolo/drivers/canopen/messages.hpp"

namespace picolo::inline v0 {
namespace {

ByteView payload(const CanFrame& frame) {
  return ByteView{frame.data}.first(frame.length);
}

}  // namespace

CanopenWheels::CanopenWheels(CanBus& bus, const CanopenWheelsConfig& config)
    : bus_(bus),
      config_(config),
      pairing_(canopen::SyncPairingConfig{.wheel_count = config.wheel_count,
                                          .window = config.pair_window}) {
  for (std::size_t i = 0; i < wheels(); ++i) {
    const CanopenWheelConfig& wheel = config.wheels[i];
    wheels_[i].counter = canopen::WheelCounter{wheel.counter};
    wheels_[i].position =
        find_field(wheel.mapping, wheel.position_index, wheel.position_subindex).value_or({});
    if (wheel.velocity_index != 0) {
      wheels_[i].velocity =
          find_field(wheel.mapping, wheel.velocity_index, wheel.velocity_subindex).value_or({});
    }
    wheels_[i].node = add_node(wheel.node);
    bool shared = false;
    for (std::size_t k = 0; k < i; ++k) {
      shared = shared || config.wheels[k].pdo_id() == wheel.pdo_id();
    }
    if (shared) { continue; }
    setups_[i] = canopen::PdoSetup{wheel.node, wheel.pdo_number(), wheel.pdo_id(), wheel.mapping,
                                   config.setup};
  }
}

std::size_t CanopenWheels::add_node(std::uint8_t node) {
  for (std::size_t i = 0; i < node_count_; ++i) {
    if (nodes_[i].health().node == node) { return i; }
  }
  nodes_[node_count_] = canopen::NodeMonitor{node, config_.nodes};
  ++node_count_;
  return node_count_ - 1;
}

bool CanopenWheels::consume(const CanFrame& frame) {
  const bool ours =
      !frame.extended && !frame.remote && frame.length <= frame.data.size() &&
      (consume_sync(frame) || consume_node_message(frame) || consume_process_data(frame));
  if (!ours) { ++counters_.foreign; }
  return ours;
}

bool CanopenWheels::consume_sync(const CanFrame& frame) {
  if (frame.id != canopen::kSyncId) { return false; }
  if (config_.produce_sync) {
    ++counters_.sync_conflicts;
    return true;
  }
  ++counters_.syncs_seen;
  pairing_.sync(frame.stamp, frame.source);
  return true;
}

bool CanopenWheels::consume_node_message(const CanFrame& frame) {
  for (std::size_t i = 0; i < node_count_; ++i) {
    const std::uint8_t node = nodes_[i].health().node;
    if (frame.id == canopen::heartbeat_id(node)) {
      consume_heartbeat(i, frame);
      return true;
    }
    if (frame.id == canopen::emergency_id(node)) {
      consume_emergency(i, frame);
      return true;
    }
  }
  for (std::size_t i = 0; i < wheels(); ++i) {
    if (!setups_[i].done() && setups_[i].consume(frame)) { return true; }
  }
  return false;
}

void CanopenWheels::consume_heartbeat(std::size_t node, const CanFrame& frame) {
  const auto state = canopen::decode_heartbeat(payload(frame));
  if (!state) {
    ++(frame.length == 0 ? counters_.short_frames : counters_.bad_states);
    return;
  }
  nodes_[node].heartbeat(frame.stamp, *state);
  if (*state != canopen::NmtState::boot_up) { return; }
  restart_wheels(node);
  for (std::size_t i = 0; i < wheels(); ++i) {
    if (wheels_[i].node == node) { setups_[i].restart(); }
  }
}

void CanopenWheels::consume_emergency(std::size_t node, const CanFrame& frame) {
  const auto emergency = canopen::decode_emergency(payload(frame));
  if (!emergency) {
    ++counters_.short_frames;
    return;
  }
  nodes_[node].emergency(frame.stamp, *emergency);
}

void CanopenWheels::restart_wheels(std::size_t node) {
  for (std::size_t i = 0; i < wheels(); ++i) {
    if (wheels_[i].node != node) { continue; }
    wheels_[i].counter.expect_restart();
    pairing_.forget(i);
  }
}

bool CanopenWheels::consume_process_data(const CanFrame& frame) {
  bool ours = false;
  bool too_short = false;
  for (std::size_t i = 0; i < wheels(); ++i) {
    const CanopenWheelConfig& wheel = config_.wheels[i];
    if (frame.id != wheel.pdo_id()) { continue; }
    ours = true;
    if (frame.length < canopen::total_bytes(wheel.mapping)) {
      too_short = true;
      continue;
    }
    decode_wheel(i, frame);
  }
  if (ours) { ++(too_short ? counters_.short_frames : counters_.process_data); }
  return ours;
}

void CanopenWheels::decode_wheel(std::size_t index, const CanFrame& frame) {
  Wheel& wheel = wheels_[index];
  nodes_[wheel.node].process_data(frame.stamp);
  if (wheel.velocity.bits != 0) {
    velocities_[index] = canopen::extract_signed(payload(frame), wheel.velocity);
  }
  if (wheel.position.bits == 0) { return; }
  const std::int64_t position =
      config_.wheels[index].position_is_signed
          ? canopen::extract_signed(payload(frame), wheel.position)
          : static_cast<std::int64_t>(canopen::extract(payload(frame), wheel.position));
  using Step = canopen::WheelCounter::Step;
  const Step step = wheel.counter.update(frame.stamp, position);
  if (step == Step::out_of_range) {
    ++counters_.out_of_range;
    return;
  }
  if (step == Step::jumped) { ++counters_.jumps; }
  publish(
      pairing_.count(index, frame.stamp, frame.source, wheel.counter.ticks(), step != Step::moved));
}

void CanopenWheels::publish(const Result<WheelTicks>& sample) {
  if (!sample) { return; }
  WheelTicks newest = *sample;
  if (sample_) {
    ++counters_.replaced;
    newest.restarted = newest.restarted || sample_->restarted;
  }
  ++counters_.samples;
  sample_ = newest;
}

Result<WheelTicks> CanopenWheels::take() {
  const Result<WheelTicks> sample = sample_;
  sample_ = Status::not_ready;
  return sample;
}

Result<WheelTicks> CanopenWheels::poll(int max_frames) {
  for (int i = 0; i < max_frames && !sample_; ++i) {
    const Result<CanFrame> frame = bus_.receive();
    if (!frame) { return frame.status(); }
    static_cast<void>(consume(*frame));
  }
  return take();
}

Status CanopenWheels::send(const CanFrame& frame) {
  const Status status = bus_.transmit(frame);
  if (!is_ok(status)) { ++counters_.tx_refused; }
  return status;
}

Status CanopenWheels::service_sync(Timestamp now) {
  if (next_sync_ == Timestamp::min()) { next_sync_ = now; }
  if (now < next_sync_) { return Status::ok; }
  const bool counted = config_.sync_counter_overflow != 0;
  const auto counter = static_cast<std::uint8_t>(
      sync_counter_ >= config_.sync_counter_overflow ? 1 : sync_counter_ + 1);
  const Status status = send(counted ? canopen::sync_frame(counter) : canopen::sync_frame());
  if (!is_ok(status)) { return status; }
  if (counted) { sync_counter_ = counter; }
  ++counters_.syncs_sent;
  pairing_.sync(now, StampSource::read);
  const std::int64_t skipped = (now - next_sync_) / config_.sync_period;
  counters_.syncs_skipped += static_cast<std::uint32_t>(skipped);
  next_sync_ += (skipped + 1) * config_.sync_period;
  return Status::ok;
}

bool CanopenWheels::set_up(std::size_t node) const {
  for (std::size_t i = 0; i < wheels(); ++i) {
    if (wheels_[i].node == node && !setups_[i].done()) { return false; }
  }
  return true;
}

/// One request at a time and node.
Status CanopenWheels::service_setup(std::size_t node, Timestamp now) {
  constexpr Duration kHaltRetry = 500ms;
  const canopen::NodeHealth& health = nodes_[node].health();
  if (health.state == canopen::NodeState::operational) {
    // It runs already: mappings can only be changed before.
    if (now < next_halt_[node]) { return Status::ok; }
    next_halt_[node] = now + kHaltRetry;
    return send(canopen::nmt_frame(canopen::NmtCommand::enter_pre_operational, health.node));
  }
  for (std::size_t i = 0; i < wheels(); ++i) {
    if (wheels_[i].node != node || setups_[i].done()) { continue; }
    CanFrame frame;
    if (!setups_[i].next(now, frame)) { return Status::ok; }
    const Status status = send(frame);
    if (is_ok(status)) { setups_[i].sent(now); }
    return status;
  }
  return Status::ok;
}

Status CanopenWheels::service(Timestamp now) {
  Status result = config_.produce_sync ? service_sync(now) : Status::ok;
  for (std::size_t i = 0; i < node_count_; ++i) {
    canopen::NodeMonitor& node = nodes_[i];
    node.service(now);
    if (!set_up(i)) {
      const Status status = service_setup(i, now);
      if (!is_ok(status)) { result = status; }
      continue;
    }
    if (!node.start_due(now)) { continue; }
    const Status status = send(canopen::nmt_frame(canopen::NmtCommand::start, node.health().node));
    if (is_ok(status)) {
      node.start_sent(now);
    } else {
      result = status;
    }
  }
  return result;
}

void CanopenWheels::request_start() {
  for (std::size_t i = 0; i < node_count_; ++i) { nodes_[i].request_start(); }
}

bool CanopenWheels::healthy() const {
  for (std::size_t i = 0; i < node_count_; ++i) {
    if (nodes_[i].health().state != canopen::NodeState::operational) { return false; }
  }
  return true;
}

CanopenWheelsCounters CanopenWheels::counters() const {
  CanopenWheelsCounters counters = counters_;
  counters.unpaired = pairing_.unpaired();
  for (const canopen::PdoSetup& setup : setups_) { counters.setup_failures += setup.failures(); }
  return counters;
}

CanopenWheels::Filters CanopenWheels::filters() const {
  Filters filters;
  static_cast<void>(filters.push_back({.id = canopen::kSyncId}));
  for (std::size_t i = 0; i < node_count_; ++i) {
    const std::uint8_t node = nodes_[i].health().node;
    static_cast<void>(filters.push_back({.id = canopen::emergency_id(node)}));
    static_cast<void>(filters.push_back({.id = canopen::heartbeat_id(node)}));
    if (config_.setup.enabled) {
      static_cast<void>(filters.push_back({.id = canopen::sdo_answer_id(node)}));
    }
  }
  for (std::size_t i = 0; i < wheels(); ++i) {
    const std::uint32_t id = config_.wheels[i].pdo_id();
    bool known = false;
    for (const CanFilter& filter : filters) { known = known || filter.id == id; }
    if (!known) { static_cast<void>(filters.push_back({.id = id})); }
  }
  return filters;
}

}  // namespace picolo::inline v0
