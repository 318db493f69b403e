// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/witmotion_wire.hpp"

#include <bit>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"

namespace picolo::inline v0::sim {

std::array<std::uint8_t, kWitMotionFrameSize> encode(const WitMotionFrame& frame) {
  std::array<std::uint8_t, kWitMotionFrameSize> bytes{};
  bytes[0] = 0x55;
  bytes[1] = frame.type;
  for (std::size_t i = 0; i < frame.words.size(); ++i) {
    store_u16_le(bytes, 2 + 2 * i, std::bit_cast<std::uint16_t>(frame.words[i]));
  }
  bytes[10] = sum8(std::span<const std::uint8_t>{bytes}.first(10));
  return bytes;
}

}  // namespace picolo::inline v0::sim
