// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One measurement of an RPLIDAR, in the units of the vendor's protocol.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

struct RplidarNode {
  std::uint32_t dist_mm_q2 = 0;   ///< quarters of a millimetre; 0 = nothing measured
  std::uint16_t angle_z_q14 = 0;  ///< clockwise, 2^14 = 90 degrees
  std::uint8_t quality = 0;
  /// Bit 0: first of a revolution. The express modes set bit 1 on all others, as the vendor's
  /// library does.
  std::uint8_t flag = 0;
};

enum class RplidarMode : std::uint8_t {
  standard = 0x81,  ///< 5 bytes a node, two check bits
  express = 0x82,   ///< 84 bytes, 32 nodes
  ultra = 0x84,     ///< 132 bytes, 96 nodes
  dense = 0x85,     ///< 84 bytes, 40 nodes
};

inline constexpr std::size_t kRplidarMaxNodes = 96;  ///< of one capsule

/// Range, bearing and `starts_sweep`; the stamp is left alone. The device raises its flag up to
/// eight nodes before its angle passes zero: the flag alone cuts revolutions.
void to_reading(const RplidarNode& node, RangeReading& reading);

}  // namespace picolo::inline v0
