// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which identifiers a consumer wants: for acceptance filters of a port and for finding overlaps
/// between consumers.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// Accepts data frames whose identifier agrees with `id` in every bit that is set in `mask`.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0x7FF;
  bool extended = false;
  [[nodiscard]] constexpr bool accepts(std::uint32_t frame_id, bool frame_extended) const {
    return frame_extended == extended && ((frame_id ^ id) & mask) == 0;
  }
};

/// True when some identifier passes both.
[[nodiscard]] constexpr bool overlap(const CanFilter& a, const CanFilter& b) {
  return a.extended == b.extended && ((a.id ^ b.id) & a.mask & b.mask) == 0;
}

}  // namespace picolo::inline v0
