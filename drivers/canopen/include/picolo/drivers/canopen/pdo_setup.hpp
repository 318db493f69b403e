// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Teaches a node which objects its TPDO carries and when, before it is started.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/drivers/canopen/pdo_mapping.hpp"
#include "picolo/drivers/canopen/sdo_client.hpp"

namespace picolo::inline v0::canopen {

struct PdoSetupConfig {
  /// Write mapping and transmission type to the nodes. They must be pre-operational: a node is
  /// started only when this is done.
  bool enabled = false;
  /// 1 to 240: every n-th SYNC; 255: by the device's own timer.
  std::uint8_t transmission_type = 1;
  std::uint16_t event_timer_ms = 0;  ///< with type 255: object 0x1800:05; 0 = left alone
  std::uint16_t heartbeat_ms = 100;  ///< object 0x1017; 0 = left alone
  Duration answer_timeout = 200ms;
  Duration retry = 1s;  ///< after an abort or a time-out
};

/// The sequence of CiA 301: invalidate, type, clear, map, count, validate. Cost: O(1) a call.
/// Context: one at a time.
class PdoSetup {
 public:
  PdoSetup() = default;
  /// Precondition: number 1 to 4, is_node(node).
  PdoSetup(std::uint8_t node, int number, std::uint16_t cob_id, const PdoMapping& mapping,
           const PdoSetupConfig& config);

  /// The node booted: begin anew.
  void restart();
  /// A request to send. False: none is due.
  [[nodiscard]] bool next(Timestamp now, CanFrame& frame);
  /// The frame of `next` is on the bus.
  void sent(Timestamp now);
  bool consume(const CanFrame& frame);
  [[nodiscard]] bool done() const { return !config_.enabled || step_ == kDone; }
  /// Sequences that a node refused or did not answer; never reset.
  [[nodiscard]] std::uint32_t failures() const { return failures_; }
  /// Of the last refusal.
  [[nodiscard]] std::uint32_t abort_code() const { return abort_code_; }

 private:
  static constexpr int kDone = 1000;
  [[nodiscard]] std::size_t fields() const;
  bool request(int step);
  void advance();

  PdoSetupConfig config_{};
  SdoClient sdo_{};
  PdoMapping mapping_{};
  std::uint16_t cob_id_ = 0;
  std::uint16_t parameters_ = 0x1800;  ///< communication object of the TPDO
  int step_ = 0;
  bool asked_ = false;  ///< the request of this step is made
  bool on_bus_ = false;
  Timestamp not_before_ = Timestamp::min();
  std::uint32_t failures_ = 0;
  std::uint32_t abort_code_ = 0;
};

}  // namespace picolo::inline v0::canopen
