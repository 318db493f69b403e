// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The packet of YDLIDAR X, G, TX and T-mini lidars: AA 55, type, count, first and last angle,
/// checksum, samples of two or three bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kYdlidarHeaderSize = 10;
inline constexpr std::size_t kYdlidarMaxSamples = 120;

struct YdlidarHeader {
  bool starts_scan = false;        ///< a "zero packet": one sample, where the turn begins
  std::uint8_t frequency_dhz = 0;  ///< turns per 10 s; 0 where the model does not say
  std::uint8_t count = 0;
  std::uint16_t first_q6 = 0;  ///< clockwise, degrees * 64
  std::uint16_t last_q6 = 0;
};

/// Precondition: bytes.size() >= kYdlidarHeaderSize; checked.
[[nodiscard]] YdlidarHeader parse_ydlidar(ByteView bytes);

/// Header, check bits of both angles, exclusive-or of all 16-bit words. The width of a sample is
/// not in the packet.
struct YdlidarFormat {
  static constexpr std::size_t kMaxFrame = kYdlidarHeaderSize + 3 * kYdlidarMaxSamples;
  static constexpr bool kVariableSize = true;
  /// 2: X2, X4, G4 without intensity; 3: with intensity; 0: whichever gives the right sum.
  std::size_t sample_bytes = 0;
  [[nodiscard]] FrameCheck check(ByteView bytes) const;
};

}  // namespace picolo::inline v0
