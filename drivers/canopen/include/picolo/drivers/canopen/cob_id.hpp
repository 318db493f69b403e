// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// CANopen identifiers (CiA 301, predefined connection set): function code << 7 | node.
#pragma once

#include <cstdint>

namespace picolo::inline v0::canopen {

inline constexpr std::uint16_t kNmtId = 0x000;
inline constexpr std::uint16_t kSyncId = 0x080;
inline constexpr std::uint16_t kEmergencyBase = 0x080;
inline constexpr std::uint16_t kHeartbeatBase = 0x700;
inline constexpr std::uint8_t kMaxNode = 127;

[[nodiscard]] constexpr bool is_node(std::uint32_t node) {
  return node >= 1 && node <= kMaxNode;
}

/// Preconditions of all below: is_node(node).
[[nodiscard]] constexpr std::uint16_t emergency_id(std::uint8_t node) {
  return static_cast<std::uint16_t>(kEmergencyBase + node);
}
[[nodiscard]] constexpr std::uint16_t heartbeat_id(std::uint8_t node) {
  return static_cast<std::uint16_t>(kHeartbeatBase + node);
}
/// Default identifier of TPDO `number`, 1 to 4: 0x180, 0x280, 0x380, 0x480 + node.
[[nodiscard]] constexpr std::uint16_t tpdo_id(int number, std::uint8_t node) {
  return static_cast<std::uint16_t>(0x080 + 0x100 * number + node);
}

static_assert(tpdo_id(1, 1) == 0x181 && tpdo_id(4, 127) == 0x4FF && heartbeat_id(100) == 0x764);

}  // namespace picolo::inline v0::canopen
