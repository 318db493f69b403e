// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where the fields of a binary VectorNav message lie.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0::vectornav {

inline constexpr std::size_t kGroups = 6;
inline constexpr std::size_t kFields = 16;

/// Bytes of each field by group and bit; 0 = not known, so its message cannot be measured.
inline constexpr std::array<std::array<std::uint8_t, kFields>, kGroups> kFieldSizes{{
    {8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8, 0},     // common
    {8, 8, 8, 2, 8, 8, 8, 4, 4, 1, 0, 0, 0, 0, 0, 0},              // time
    {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 40, 0, 0, 0},     // imu
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0, 0},        // gnss
    {2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24, 12, 4, 0, 0},  // attitude
    {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64, 0, 0, 0},    // ins
}};

/// Groups present, masks, sizes.
struct Layout {
  bool known = false;     ///< all of it could be measured
  bool complete = false;  ///< the header is there
  std::size_t header_size = 0;
  std::size_t payload_size = 0;
};

/// `visit(group, bit, offset)` for every field in the order of the wire. Cost: O(fields).
template <typename Visitor>
constexpr Layout walk(ByteView bytes, Visitor&& visit) {
  Layout layout;
  if (bytes.size() < 2) { return {.known = true}; }
  const unsigned groups = bytes[1];
  if (groups == 0 || (groups >> kGroups) != 0) { return layout; }
  layout.known = true;
  layout.header_size = 2 + 2 * static_cast<std::size_t>(std::popcount(groups));
  if (bytes.size() < layout.header_size) { return layout; }
  layout.complete = true;
  std::size_t mask_at = 2;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if ((groups & (1U << group)) == 0) { continue; }
    const unsigned mask = load_u16_le(bytes, mask_at);
    mask_at += 2;
    if (mask == 0) { layout.known = false; }
    for (std::size_t bit = 0; bit < kFields; ++bit) {
      if ((mask & (1U << bit)) == 0) { continue; }
      if (kFieldSizes[group][bit] == 0) { layout.known = false; }
      visit(group, bit, layout.header_size + layout.payload_size);
      layout.payload_size += kFieldSizes[group][bit];
    }
  }
  return layout;
}

}  // namespace picolo::inline v0::vectornav
