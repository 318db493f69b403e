// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/sync_pairing.hpp"

#include <algorithm>
#include <bit>

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t bit(std::size_t wheel) {
  return static_cast<std::uint8_t>(1U << wheel);
}

Duration distance(Timestamp a, Timestamp b) {
  return a < b ? b - a : a - b;
}

}  // namespace

void SyncPairing::abandon(Epoch& epoch) {
  unpaired_ += static_cast<std::uint32_t>(std::popcount(epoch.present));
  epoch = {};
}

void SyncPairing::sync(Timestamp stamp, StampSource source) {
  abandon(previous_);
  previous_ = current_;
  current_ = {.sync_stamp = stamp, .sync_source = source, .has_sync = true};
}

bool SyncPairing::takes(const Epoch& epoch, std::size_t wheel, Timestamp stamp) const {
  if ((epoch.present & bit(wheel)) != 0) { return false; }
  if (epoch.present != 0) { return distance(stamp, epoch.first_stamp) <= config_.window; }
  return epoch.has_sync && distance(stamp, epoch.sync_stamp) <= config_.window;
}

SyncPairing::Epoch& SyncPairing::epoch_of(std::size_t wheel, Timestamp stamp) {
  const bool before_sync = current_.has_sync && stamp < current_.sync_stamp;
  if (before_sync && takes(previous_, wheel, stamp)) { return previous_; }
  if (!takes(current_, wheel, stamp)) { abandon(current_); }
  return current_;
}

Result<WheelTicks> SyncPairing::count(std::size_t wheel, Timestamp stamp, StampSource source,
                                      std::int64_t ticks, bool restarted) {
  Epoch& epoch = epoch_of(wheel, stamp);
  if (epoch.present == 0 || stamp < epoch.first_stamp) {
    epoch.first_stamp = stamp;
    epoch.first_source = source;
  }
  epoch.present |= bit(wheel);
  epoch.ticks[wheel] = ticks;
  if (restarted) { bases_ |= bit(wheel); }
  if (std::popcount(epoch.present) < config_.wheel_count) { return Status::not_ready; }

  WheelTicks sample{.stamp = epoch.has_sync ? epoch.sync_stamp : epoch.first_stamp,
                    .source = epoch.has_sync ? epoch.sync_source : epoch.first_source,
                    .restarted = bases_ != 0,
                    .ticks = epoch.ticks};
  sample.stamp = std::max(sample.stamp, last_stamp_);
  last_stamp_ = sample.stamp;
  bases_ = 0;
  epoch = {};
  return sample;
}

void SyncPairing::forget(std::size_t wheel) {
  for (Epoch* epoch : {&previous_, &current_}) {
    if ((epoch->present & bit(wheel)) == 0) { continue; }
    ++unpaired_;
    epoch->present = static_cast<std::uint8_t>(epoch->present & ~bit(wheel));
  }
}

}  // namespace picolo::inline v0
