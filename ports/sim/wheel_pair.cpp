// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/wheel_pair.hpp"

namespace picolo::inline v0::sim {

WheelPair::WheelPair(const WheelPairConfig& config, EncoderSource& left, EncoderSource& right,
                     SimCanBus& bus, FaultPlan& faults, Timestamp start)
    : config_(config),
      bus_(bus),
      faults_(faults),
      start_(start),
      next_sync_(start + config.sync_period),
      left_link_(bus, faults, Device::wheel_left, start),
      right_link_(bus, faults, Device::wheel_right, start),
      left_(config.left, left, left_link_, start),
      right_(config.right, right, right_link_, start) {}

void WheelPair::advance_to(Timestamp until) {
  follow_faults(until);
  for (auto frame = bus_.take_sent(until); frame; frame = bus_.take_sent(until)) { hear(*frame); }
  const bool produces_sync = config_.sync_period > Duration{0};
  for (; produces_sync && next_sync_ <= until; next_sync_ += config_.sync_period) {
    CanFrame sync{.stamp = next_sync_, .id = 0x080};
    sync.stamp = bus_.deliver(sync);
    hear(sync);
  }
  left_.advance_to(until);
  right_.advance_to(until);
  left_link_.release(until);
  right_link_.release(until);
}

void WheelPair::follow_faults(Timestamp now) {
  const bool gone = faults_.active(Device::can_bus, FaultKind::disconnect, now - start_);
  const bool was_gone = bus_.status().state == CanState::absent;
  if (gone != was_gone) { bus_.set_state(gone ? CanState::absent : CanState::active); }
}

void WheelPair::hear(const CanFrame& frame) {
  left_.hear(frame);
  right_.hear(frame);
}

}  // namespace picolo::inline v0::sim
