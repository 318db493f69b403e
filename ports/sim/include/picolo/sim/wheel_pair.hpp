// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two CANopen nodes of a differential drive on their bus, and SYNC when nobody else sends it.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/sim/canopen_node.hpp"
#include "picolo/sim/fault_plan.hpp"
#include "picolo/sim/links.hpp"
#include "picolo/sim/sim_can_bus.hpp"

namespace picolo::inline v0::sim {

struct WheelPairConfig {
  CanopenNodeConfig left{.node = 1};
  CanopenNodeConfig right{.node = 2};
  Duration sync_period{};  ///< of a SYNC producer among the vehicle's own nodes; 0: the firmware
                           ///< sends it
  [[nodiscard]] constexpr bool valid() const {
    return left.valid() && right.valid() && left.node != right.node && sync_period >= Duration{0};
  }
};

/// Both nodes are powered up at `start`.
class WheelPair {
 public:
  WheelPair(const WheelPairConfig& config, EncoderSource& left, EncoderSource& right,
            SimCanBus& bus, FaultPlan& faults, Timestamp start);

  /// Lets the bus live until `until`: hands the firmware's frames to the nodes and puts theirs on
  /// the wire.
  /// Precondition: both sources can be read up to `until`.
  void advance_to(Timestamp until);
  [[nodiscard]] const CanopenNode& left() const { return left_; }
  [[nodiscard]] const CanopenNode& right() const { return right_; }

 private:
  void follow_faults(Timestamp now);
  void hear(const CanFrame& frame);

  WheelPairConfig config_;
  SimCanBus& bus_;
  FaultPlan& faults_;
  Timestamp start_;
  Timestamp next_sync_;
  CanLink left_link_;
  CanLink right_link_;
  CanopenNode left_;
  CanopenNode right_;
};

}  // namespace picolo::inline v0::sim
