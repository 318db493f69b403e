// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/node_monitor.hpp"

namespace picolo::inline v0::canopen {

NodeMonitor::NodeMonitor(std::uint8_t node, const NodeMonitorConfig& config) : config_(config) {
  health_.node = node;
}

void NodeMonitor::request_start() {
  wants_start_ = true;
  starts_left_ = config_.max_starts;
  next_start_ = Timestamp::min();
  health_.gave_up_starting = false;
}

void NodeMonitor::enter(NodeState state) {
  if (health_.state == NodeState::lost) { ++health_.recoveries; }
  health_.state = state;
  if (state == NodeState::operational) {
    wants_start_ = false;
    health_.gave_up_starting = false;
  }
}

void NodeMonitor::heartbeat(Timestamp stamp, NmtState state) {
  health_.last_heard = stamp;
  last_heartbeat_ = stamp;
  has_heartbeat_ = true;
  switch (state) {
    case NmtState::boot_up:
      ++health_.boots;
      enter(NodeState::booted);
      if (config_.auto_start) { request_start(); }
      break;
    case NmtState::pre_operational:
      enter(NodeState::pre_operational);
      if (config_.auto_start && !wants_start_ && !health_.gave_up_starting) { request_start(); }
      break;
    case NmtState::operational: enter(NodeState::operational); break;
    case NmtState::stopped: enter(NodeState::stopped); break;
  }
}

void NodeMonitor::process_data(Timestamp stamp) {
  health_.last_heard = stamp;
  // Who once sent heartbeats is lost without them, even when data still comes.
  if (health_.state == NodeState::lost && has_heartbeat_) { return; }
  if (health_.state != NodeState::operational) { enter(NodeState::operational); }
}

void NodeMonitor::emergency(Timestamp stamp, const Emergency& emergency) {
  health_.last_heard = stamp;
  health_.emergency_code = emergency.code;
  if (emergency.code == 0) { return; }
  health_.last_emergency_code = emergency.code;
  ++health_.emergencies;
}

void NodeMonitor::service(Timestamp now) {
  if (wants_start_ && starts_left_ == 0 && now >= next_start_) {
    wants_start_ = false;
    health_.gave_up_starting = true;
  }
  const Duration limit = config_.heartbeat_timeout;
  if (limit == Duration{0} || health_.state == NodeState::silent ||
      health_.state == NodeState::lost) {
    return;
  }
  const bool silent = now - health_.last_heard > limit;
  const bool no_heartbeat = has_heartbeat_ && now - last_heartbeat_ > limit;
  if (!silent && !no_heartbeat) { return; }
  health_.state = NodeState::lost;
  ++health_.losses;
}

bool NodeMonitor::start_due(Timestamp now) const {
  return wants_start_ && starts_left_ > 0 && now >= next_start_;
}

void NodeMonitor::start_sent(Timestamp now) {
  ++health_.starts_sent;
  --starts_left_;
  next_start_ = now + config_.start_retry;
}

}  // namespace picolo::inline v0::canopen
