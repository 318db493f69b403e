// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/event_ring.hpp"

#include <limits>

namespace picolo::inline v0 {

const char* to_string(EventCode code) {
  switch (code) {
    case EventCode::started: return "started";
    case EventCode::state_changed: return "state_changed";
    case EventCode::reason_changed: return "reason_changed";
    case EventCode::overrun: return "overrun";
    case EventCode::frames_slipped: return "frames_slipped";
    case EventCode::sweep_replaced: return "sweep_replaced";
    case EventCode::sweep_dropped: return "sweep_dropped";
    case EventCode::pose_jump: return "pose_jump";
    case EventCode::device_lost: return "device_lost";
    case EventCode::device_back: return "device_back";
    case EventCode::pose_set: return "pose_set";
    case EventCode::mode_set: return "mode_set";
    case EventCode::command_refused: return "command_refused";
    case EventCode::impersonated: return "impersonated";
    case EventCode::sensor_doubted: return "sensor_doubted";
    case EventCode::watchdog_reset: return "watchdog_reset";
  }
  return "unknown";
}

std::uint32_t EventRing::seal() const {
  constexpr std::uint32_t kMagic = 0x52435031U;  // changes with the layout of Event
  std::uint32_t mixed = kMagic ^ (total_ * 2654435761U);
  mixed = (mixed ^ (mixed >> 15)) * 2246822519U;
  return (mixed ^ next_) * 3266489917U;
}

bool EventRing::attach() {
  const bool index_holds = next_ < kCapacity && (total_ >= kCapacity || total_ == next_);
  if (seal_ == seal() && index_holds) { return total_ > 0; }
  clear();
  return false;
}

void EventRing::clear() {
  events_ = {};
  total_ = 0;
  next_ = 0;
  seal_ = seal();
}

void EventRing::push(const Event& event) {
  events_[next_] = event;
  next_ = (next_ + 1) % kCapacity;
  if (total_ < std::numeric_limits<std::uint32_t>::max()) { ++total_; }
  seal_ = seal();
}

const Event& EventRing::operator[](std::size_t index) const {
  const std::size_t oldest = total_ < kCapacity ? 0 : next_;
  return events_[(oldest + index) % kCapacity];
}

}  // namespace picolo::inline v0
