// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is known about one CANopen node: its state from heartbeats, its silence, its emergencies,
/// and when to start it.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/drivers/canopen/messages.hpp"

namespace picolo::inline v0::canopen {

enum class NodeState : std::uint8_t { silent, booted, pre_operational, operational, stopped, lost };

/// Counters are never reset.
struct NodeHealth {
  std::uint8_t node = 0;
  /// Silent: nothing heard since start; lost: heard once, not any more.
  NodeState state = NodeState::silent;
  Timestamp last_heard{};  ///< any frame of the node
  std::uint32_t boots = 0;
  std::uint32_t losses = 0;
  std::uint32_t recoveries = 0;
  std::uint32_t starts_sent = 0;
  std::uint32_t emergencies = 0;          ///< error resets not counted
  std::uint16_t emergency_code = 0;       ///< last one; 0 when the node reported the error gone
  std::uint16_t last_emergency_code = 0;  ///< last one that was an error
  bool gave_up_starting = false;          ///< all attempts used; a boot-up or a request begins anew
};

struct NodeMonitorConfig {
  /// Silence after which a node is lost. 0 = never. At least twice the producer's period (object
  /// 0x1017).
  Duration heartbeat_timeout = 500ms;
  /// Start a node that shows boot-up or pre-operational.
  bool auto_start = true;
  Duration start_retry = 200ms;
  int max_starts = 10;  ///< attempts until the node is heard operational or boots again
  [[nodiscard]] constexpr bool valid() const {
    return heartbeat_timeout >= Duration{0} && start_retry > Duration{0} && max_starts >= 1;
  }
};

/// Cost: O(1). Context: one at a time.
class NodeMonitor {
 public:
  NodeMonitor() = default;
  NodeMonitor(std::uint8_t node, const NodeMonitorConfig& config);

  void heartbeat(Timestamp stamp, NmtState state);
  /// A process data object: only an operational node sends them.
  void process_data(Timestamp stamp);
  void emergency(Timestamp stamp, const Emergency& emergency);
  /// Forget failed attempts and start the node from the next `start_due` on, until it is
  /// operational.
  void request_start();
  /// Notices silence. Call every cycle.
  void service(Timestamp now);
  /// True when an NMT start should go out now.
  [[nodiscard]] bool start_due(Timestamp now) const;
  /// The start was accepted by the bus.
  void start_sent(Timestamp now);

  [[nodiscard]] const NodeHealth& health() const { return health_; }

 private:
  void enter(NodeState state);

  NodeMonitorConfig config_{};
  NodeHealth health_{};
  Timestamp last_heartbeat_{};
  Timestamp next_start_ = Timestamp::min();
  int starts_left_ = 0;
  bool has_heartbeat_ = false;
  bool wants_start_ = false;
};

}  // namespace picolo::inline v0::canopen
