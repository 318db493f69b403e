// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Wheel encoders behind CANopen: starts the nodes, watches their heartbeats, pairs their positions
/// by SYNC.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/canopen/canopen_wheels_config.hpp"
#include "picolo/drivers/canopen/node_monitor.hpp"
#include "picolo/drivers/common/sync_pairing.hpp"
#include "picolo/drivers/common/wheel_counter.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// Never reset. Node by node figures are in `NodeHealth`.
struct CanopenWheelsCounters {
  std::uint32_t process_data = 0;  ///< TPDOs decoded
  std::uint32_t samples = 0;       ///< complete samples
  std::uint32_t replaced = 0;      ///< samples nobody took before the next one
  std::uint32_t foreign = 0;       ///< frames of somebody else
  /// TPDOs shorter than their mapping, heartbeats and emergencies without content.
  std::uint32_t short_frames = 0;
  std::uint32_t bad_states = 0;    ///< heartbeats with a state that CiA 301 does not know
  std::uint32_t unpaired = 0;      ///< counts without their partner
  std::uint32_t out_of_range = 0;  ///< positions beyond the modulus
  std::uint32_t jumps = 0;         ///< restarts that nobody announced
  std::uint32_t syncs_seen = 0;
  std::uint32_t syncs_sent = 0;
  /// Periods without SYNC because `service` came late or the bus refused.
  std::uint32_t syncs_skipped = 0;
  std::uint32_t sync_conflicts = 0;  ///< SYNC of somebody else while we produce it
  std::uint32_t tx_refused = 0;      ///< frames that the bus did not take
  std::uint32_t setup_failures = 0;  ///< nodes that refused their mapping or did not answer
};

/// Polling shell. `consume` takes one frame, `service` does what time asks for. The caller either
/// drains the bus once and offers each frame to all of its consumers, or lets `poll` do both for a
/// bus of its own.
/// Precondition: config.valid(). Context: one at a time. Memory: 2.2 KiB, no heap.
class CanopenWheels {
 public:
  CanopenWheels(CanBus& bus, const CanopenWheelsConfig& config);

  /// Takes a frame; false (and counted foreign) when it is none of ours. Cost: O(wheels). Does not
  /// touch the bus.
  bool consume(const CanFrame& frame);
  /// The newest sample that `consume` completed, once. `not_ready`: none.
  [[nodiscard]] Result<WheelTicks> take();
  /// Receives at most `max_frames` frames and stops at the first complete sample.
  /// `not_ready`: no sample yet. `disconnected` and the like: from the bus.
  [[nodiscard]] Result<WheelTicks> poll(int max_frames);
  /// Heartbeat time-outs, NMT starts, SYNC. Call every cycle, after the bus was drained. Cost: at
  /// most one frame a node plus SYNC. Returns the bus's status when it refused a frame; the frame
  /// is tried again in the next call.
  Status service(Timestamp now);
  /// Start all nodes from the next `service` on, in bounded attempts, until they are operational.
  void request_start();

  /// Nodes in the order of their wheels; wheels of one node share it.
  [[nodiscard]] std::size_t node_count() const { return node_count_; }
  [[nodiscard]] const canopen::NodeHealth& node(std::size_t index) const {
    return nodes_[index].health();
  }
  /// Why the TPDO of a wheel could not be set up: CANopen's abort code, 0 = none or no answer.
  [[nodiscard]] std::uint32_t setup_abort_code(std::size_t wheel) const {
    return setups_[wheel].abort_code();
  }
  /// Every node is operational.
  [[nodiscard]] bool healthy() const;
  /// Last velocity that a TPDO carried, in the drive's own unit, sign as the drive sent it; 0
  /// before.
  [[nodiscard]] std::int64_t velocity(std::size_t wheel) const { return velocities_[wheel]; }
  [[nodiscard]] CanopenWheelsCounters counters() const;

  /// What this driver listens to: SYNC, then emergencies, heartbeats and TPDOs; answers to its
  /// requests where it sets the nodes up.
  using Filters = FixedVector<CanFilter, 1 + 4 * kMaxWheels>;
  [[nodiscard]] Filters filters() const;

 private:
  struct Wheel {
    canopen::WheelCounter counter;
    canopen::PdoField position{};
    canopen::PdoField velocity{};  ///< bits 0 = none
    std::size_t node = 0;
  };

  [[nodiscard]] std::size_t wheels() const { return static_cast<std::size_t>(config_.wheel_count); }
  [[nodiscard]] std::size_t add_node(std::uint8_t node);
  bool consume_sync(const CanFrame& frame);
  bool consume_node_message(const CanFrame& frame);
  bool consume_process_data(const CanFrame& frame);
  void consume_heartbeat(std::size_t node, const CanFrame& frame);
  void consume_emergency(std::size_t node, const CanFrame& frame);
  void decode_wheel(std::size_t index, const CanFrame& frame);
  void restart_wheels(std::size_t node);
  void publish(const Result<WheelTicks>& sample);
  Status send(const CanFrame& frame);
  Status service_sync(Timestamp now);
  Status service_setup(std::size_t node, Timestamp now);
  [[nodiscard]] bool set_up(std::size_t node) const;

  CanBus& bus_;
  CanopenWheelsConfig config_;
  canopen::SyncPairing pairing_;
  std::array<Wheel, kMaxWheels> wheels_{};
  std::array<std::int64_t, kMaxWheels> velocities_{};
  std::array<canopen::NodeMonitor, kMaxWheels> nodes_{};
  std::array<canopen::PdoSetup, kMaxWheels> setups_{};  ///< by wheel; disabled where shared
  std::array<Timestamp, kMaxWheels> next_halt_{};       ///< by node
  std::size_t node_count_ = 0;
  Result<WheelTicks> sample_{Status::not_ready};
  Timestamp next_sync_ = Timestamp::min();
  std::uint8_t sync_counter_ = 0;
  CanopenWheelsCounters counters_{};
};

}  // namespace picolo::inline v0
