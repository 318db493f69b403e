// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A WitMotion sensor as the tests imagine it, independent of the decoder.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>

#include "support/bytes.hpp"

namespace picolo::test {

inline Bytes wire_frame(std::uint8_t type, const std::array<int, 4>& words) {
  Bytes bytes{0x55, type};
  for (const int word : words) {
    const auto bits = static_cast<unsigned>(word) & 0xFFFFU;
    bytes.push_back(static_cast<std::uint8_t>(bits % 256));
    bytes.push_back(static_cast<std::uint8_t>(bits / 256));
  }
  bytes.push_back(static_cast<std::uint8_t>(std::accumulate(bytes.begin(), bytes.end(), 0U) % 256));
  return bytes;
}

/// Acceleration, rate and angle of group `index`; the words tell the group.
inline Bytes wire_group(int index) {
  return join({wire_frame(0x51, {index, 0x5551, 2048, 2500}),
               wire_frame(0x52, {-index, 0x5255, 0x5552, 0}),
               wire_frame(0x53, {index, index, index, 0x4682})});
}

}  // namespace picolo::test
