// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One classic CAN controller, as drivers and the controller see it.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

/// A classic CAN frame. Error frames and CAN FD frames never leave a port.
struct CanFrame {
  Timestamp stamp{};  ///< end of frame on the wire, as near to it as `source` says
  StampSource source = StampSource::read;
  std::uint32_t id = 0;  ///< 11 bits, or 29 bits when `extended`
  bool extended = false;
  bool remote = false;                 ///< a request without data
  std::uint8_t length = 0;             ///< 0..8
  std::array<std::uint8_t, 8> data{};  ///< beyond `length` unspecified
};

/// ISO 11898-1 fault confinement, plus what a port adds around it.
enum class CanState : std::uint8_t { active, warning, passive, bus_off, absent };

struct CanStatus {
  CanState state = CanState::active;
  std::uint32_t received = 0;     ///< frames handed out
  std::uint32_t transmitted = 0;  ///< frames accepted for sending
  std::uint32_t rx_lost = 0;      ///< frames lost before `receive` (full queue or FIFO)
  std::uint32_t tx_refused = 0;   ///< frames that found the send queue full
  std::uint32_t error_frames = 0;
  std::uint32_t restarts = 0;  ///< recoveries from bus-off
};

/// One classic CAN controller. Never blocks; all calls from one context. Counters are never reset.
/// Own frames are not received. Cost: each call is bounded by the port, at most one frame copied.
/// Ports are held to this by hal/conformance/can_bus.hpp.
class CanBus {
 public:
  /// The oldest waiting frame; stamps never decrease. At least 20 frames may wait. `not_ready`:
  /// none waits. `disconnected`: the controller is gone or down; may come back.
  virtual Result<CanFrame> receive() = 0;
  /// Queues one frame; stamp and source are ignored. `full`: no room now, or bus-off; try in a
  /// later cycle. `invalid_argument`: length or id out of range. `disconnected`: as above.
  virtual Status transmit(const CanFrame& frame) = 0;
  [[nodiscard]] virtual CanStatus status() const = 0;

 protected:
  CanBus() = default;
  CanBus(const CanBus&) = default;
  CanBus& operator=(const CanBus&) = default;
  ~CanBus() = default;
};

}  // namespace picolo::inline v0
