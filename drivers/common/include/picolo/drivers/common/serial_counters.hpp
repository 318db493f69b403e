// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a serial device's driver counts.
#pragma once

#include <cstdint>

#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

/// Never reset. What does not apply to a device stays 0.
struct SerialCounters {
  std::uint32_t bytes = 0;
  std::uint32_t frames = 0;          ///< accepted packets, capsules, lines or messages
  std::uint32_t bad_checksums = 0;   ///< candidates with a wrong checksum
  std::uint32_t implausible = 0;     ///< right checksum, impossible content
  std::uint32_t skipped_bytes = 0;   ///< bytes that were part of no frame
  std::uint32_t samples = 0;         ///< readings or IMU samples delivered
  std::uint32_t saturated = 0;       ///< samples with an axis at the end of its range
  std::uint32_t missed = 0;          ///< frames that the device numbered but that never came
  std::uint32_t clock_restarts = 0;  ///< the device's clock did not fit ours any more
  std::uint32_t restarts = 0;        ///< the device was silent and was started again
};

/// `counters` with what the framer counts filled in.
[[nodiscard]] constexpr SerialCounters with_framer(SerialCounters counters,
                                                   const FramerCounters& framer) {
  counters.frames = framer.frames;
  counters.bad_checksums = framer.bad_checksums;
  counters.implausible += framer.implausible;
  counters.skipped_bytes = framer.skipped_bytes;
  return counters;
}

}  // namespace picolo::inline v0
