// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Puts the counts of several wheels that were sampled on the same SYNC into one sample, whatever
/// order and delay the bus gave them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

struct SyncPairingConfig {
  int wheel_count = 2;
  /// Counts of one epoch arrive within this time of each other and of their SYNC. Shorter than the
  /// period of the counts, longer than the jitter of their stamps.
  Duration window = 8ms;
  [[nodiscard]] constexpr bool valid() const {
    return wheel_count >= 1 && wheel_count <= kMaxWheels && window > Duration{0};
  }
};

/// A SYNC opens an epoch; each wheel's first count after it belongs to the epoch. Without SYNC
/// (timer or event driven TPDOs) an epoch opens with the first count, and with any count that
/// cannot belong to the open one. A count stamped before the newest SYNC belongs to the epoch
/// before it, so that a SYNC produced while older frames still wait in the receive queue does no
/// harm.
/// Cost: O(wheels). Context: one at a time.
class SyncPairing {
 public:
  explicit SyncPairing(const SyncPairingConfig& config = {}) : config_(config) {}

  void sync(Timestamp stamp, StampSource source);
  /// One wheel's count. `restarted`: it is a base, not motion.
  /// Returns the sample that this count completes, else `not_ready`. Precondition: wheel <
  /// wheel_count.
  [[nodiscard]] Result<WheelTicks> count(std::size_t wheel, Timestamp stamp, StampSource source,
                                         std::int64_t ticks, bool restarted);
  /// What the wheel has in open epochs is no longer to be used: its device restarted.
  void forget(std::size_t wheel);
  /// Counts that found no partner; never reset.
  [[nodiscard]] std::uint32_t unpaired() const { return unpaired_; }

 private:
  struct Epoch {
    std::array<std::int64_t, kMaxWheels> ticks{};
    Timestamp sync_stamp{};
    Timestamp first_stamp{};
    StampSource sync_source = StampSource::read;
    StampSource first_source = StampSource::read;
    bool has_sync = false;
    std::uint8_t present = 0;  ///< bit per wheel
  };

  [[nodiscard]] bool takes(const Epoch& epoch, std::size_t wheel, Timestamp stamp) const;
  [[nodiscard]] Epoch& epoch_of(std::size_t wheel, Timestamp stamp);
  void abandon(Epoch& epoch);

  SyncPairingConfig config_;
  Epoch current_{};
  Epoch previous_{};
  std::uint8_t bases_ = 0;  ///< bit per wheel: its count became a base since the last sample
  Timestamp last_stamp_ = Timestamp::min();
  std::uint32_t unpaired_ = 0;
};

}  // namespace picolo::inline v0

namespace picolo::inline v0::canopen {
using v0::SyncPairing;
using v0::SyncPairingConfig;
}  // namespace picolo::inline v0::canopen
