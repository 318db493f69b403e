// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Positions of single wheels, as event-driven CAN devices send them, to samples of all wheels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/common/sync_pairing.hpp"
#include "picolo/drivers/common/wheel_counter.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// Never reset.
struct CanWheelsCounters {
  std::uint32_t frames = 0;        ///< of ours
  std::uint32_t samples = 0;       ///< complete samples
  std::uint32_t replaced = 0;      ///< samples nobody took before the next one
  std::uint32_t foreign = 0;       ///< frames of somebody else
  std::uint32_t short_frames = 0;  ///< shorter than their content
  std::uint32_t damaged = 0;       ///< wrong checksum, or a number that is none
  std::uint32_t missed = 0;        ///< frames that the device numbered but that never came
  std::uint32_t unpaired = 0;      ///< counts without their partner
  std::uint32_t out_of_range = 0;  ///< positions beyond the modulus
  std::uint32_t jumps = 0;         ///< restarts that nobody announced
  std::uint32_t losses = 0;        ///< devices that fell silent
  std::uint32_t requests = 0;      ///< frames sent
  std::uint32_t tx_refused = 0;    ///< frames that the bus did not take
};

struct WheelCollectorConfig {
  int wheel_count = 2;
  /// Counts of all wheels arrive within this time. Shorter than their period.
  Duration pair_window = 8ms;
  std::array<WheelCounterConfig, kMaxWheels> wheels{};
  [[nodiscard]] constexpr bool valid() const {
    if (wheel_count < 1 || wheel_count > kMaxWheels || pair_window <= Duration{0}) { return false; }
    for (const WheelCounterConfig& wheel : wheels) {
      if (!wheel.valid()) { return false; }
    }
    return true;
  }
};

/// Cost: O(wheels). Context: one at a time.
class WheelCollector {
 public:
  explicit WheelCollector(const WheelCollectorConfig& config = {});

  /// A position as decoded, see WheelCounter. Precondition: wheel < wheel_count.
  void position(std::size_t wheel, Timestamp stamp, StampSource source, std::int64_t position);
  /// The device of this wheel started anew: its next position is a base.
  void restart(std::size_t wheel);
  /// The newest complete sample, once. `not_ready`: none.
  [[nodiscard]] Result<WheelTicks> take();
  /// Adds what was counted here.
  void add_to(CanWheelsCounters& counters) const;

 private:
  SyncPairing pairing_;
  std::array<WheelCounter, kMaxWheels> counters_{};
  Result<WheelTicks> sample_{Status::not_ready};
  CanWheelsCounters counted_{};
};

}  // namespace picolo::inline v0
