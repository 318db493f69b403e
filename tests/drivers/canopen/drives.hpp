// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// CANopen drives as the tests imagine them: what they put on the bus.
#pragma once

#include <cstdint>

#include "picolo/hal/can_bus.hpp"
#include "support/fake_can_bus.hpp"

namespace picolo::test {

inline std::uint8_t byte_of(std::int64_t value, int index) {
  return static_cast<std::uint8_t>((static_cast<std::uint64_t>(value) >> (8 * index)) & 0xFFU);
}

inline CanFrame tpdo(Timestamp stamp, std::uint32_t id, std::int64_t position) {
  return can_frame(
      stamp, id,
      {byte_of(position, 0), byte_of(position, 1), byte_of(position, 2), byte_of(position, 3)});
}

/// Two 32-bit values in one frame.
inline CanFrame tpdo(Timestamp stamp, std::uint32_t id, std::int64_t first, std::int64_t second) {
  CanFrame frame = tpdo(stamp, id, first);
  frame.length = 8;
  for (int i = 0; i < 4; ++i) {
    frame.data.at(static_cast<std::size_t>(4 + i)) = byte_of(second, i);
  }
  return frame;
}

inline CanFrame sync_at(Timestamp stamp) {
  return can_frame(stamp, 0x080);
}
inline CanFrame heartbeat(Timestamp stamp, std::uint8_t node, std::uint8_t state) {
  return can_frame(stamp, 0x700U + node, {state});
}

inline constexpr std::uint8_t kBootUp = 0x00;
inline constexpr std::uint8_t kOperational = 0x05;
inline constexpr std::uint8_t kPreOperational = 0x7F;

}  // namespace picolo::test
