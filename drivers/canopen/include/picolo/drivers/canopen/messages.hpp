// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The fixed CANopen messages: NMT command, SYNC, heartbeat, emergency. Pure codec, no I/O.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0::canopen {

enum class NmtCommand : std::uint8_t {
  start = 0x01,
  stop = 0x02,
  enter_pre_operational = 0x80,
  reset_node = 0x81,
  reset_communication = 0x82,
};

/// What a heartbeat says. `boot_up` is sent once, after a reset.
enum class NmtState : std::uint8_t {
  boot_up = 0x00,
  stopped = 0x04,
  operational = 0x05,
  pre_operational = 0x7F
};

struct Emergency {
  std::uint16_t code = 0;  ///< 0 = the error is gone; 0x8110 overrun, 0x8130 heartbeat lost, ...
  std::uint8_t error_register = 0;       ///< object 0x1001
  std::array<std::uint8_t, 5> vendor{};  ///< absent bytes read 0
};

/// A command to one node, or to all with node 0.
[[nodiscard]] CanFrame nmt_frame(NmtCommand command, std::uint8_t node);
[[nodiscard]] CanFrame sync_frame();
/// A SYNC that carries the counter of object 0x1019, 1 to 240.
[[nodiscard]] CanFrame sync_frame(std::uint8_t counter);

/// The payload of a heartbeat. The toggle bit of node guarding is masked.
/// `corrupt`: no byte, or a state that CiA 301 does not know.
[[nodiscard]] Result<NmtState> decode_heartbeat(ByteView data);
/// `corrupt`: fewer than the three bytes that carry code and register.
[[nodiscard]] Result<Emergency> decode_emergency(ByteView data);

}  // namespace picolo::inline v0::canopen
