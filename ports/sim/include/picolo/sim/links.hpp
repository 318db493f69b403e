// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The cables between the simulated devices and the wires: where faults strike.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/sim/fault_plan.hpp"
#include "picolo/sim/ring.hpp"
#include "picolo/sim/sim_can_bus.hpp"
#include "picolo/sim/sim_serial_port.hpp"

namespace picolo::inline v0::sim {

/// A CAN node's cable. Frames leave in the order of `send`; delayed ones hold back their
/// successors.
class CanLink {
 public:
  CanLink(SimCanBus& bus, FaultPlan& faults, Device device, Timestamp start);
  /// Queues a frame that goes on the bus not before `frame.stamp`. Beyond 256 held-back frames the
  /// newest are dropped.
  void send(const CanFrame& frame);
  /// Puts what is due by `until` on the bus.
  void release(Timestamp until);
  [[nodiscard]] bool suffers(FaultKind kind, Timestamp now) const;

 private:
  SimCanBus& bus_;
  FaultPlan& faults_;
  Device device_;
  Timestamp start_;
  Ring<CanFrame, 256> held_{};
};

/// A serial device's cable.
class SerialLink {
 public:
  SerialLink(SimSerialPort& port, FaultPlan& faults, Device device, Timestamp start);
  /// Sends one packet of at most 64 bytes, not before `earliest`.
  void send(std::span<const std::uint8_t> packet, Timestamp earliest);
  /// Plugs and unplugs the port as the faults demand.
  void update(Timestamp now);
  [[nodiscard]] bool suffers(FaultKind kind, Timestamp now) const;

 private:
  SimSerialPort& port_;
  FaultPlan& faults_;
  Device device_;
  Timestamp start_;
};

}  // namespace picolo::inline v0::sim
