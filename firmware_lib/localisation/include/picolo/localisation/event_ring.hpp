// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The last 256 things worth telling, readable over CAN and after a watchdog reset.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "picolo/core/time.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::inline v0 {

/// What happened. The number goes over the wire and into memory that survives resets: append only.
enum class EventCode : std::uint8_t {
  started = 0,         ///< argument: 1 when the ring came through a reset
  state_changed = 1,   ///< from, to, reason
  reason_changed = 2,  ///< within a state; argument: the reason before
  overrun = 3,         ///< argument: index of the task in the table
  frames_slipped = 4,  ///< argument: how many minor frames were not run
  /// A newer sweep came before the older was matched; argument: sweeps replaced so far.
  sweep_replaced = 5,
  sweep_dropped = 6,  ///< it could not be undistorted; argument: sweeps dropped so far
  pose_jump = 7,      ///< a correction moved the published pose; argument: by how many millimetres
  device_lost = 8,    ///< argument: index of the device (0 wheels, 1 lidar, 2 IMU)
  device_back = 9,    ///< argument: as above
  pose_set = 10,      ///< by a command
  mode_set = 11,      ///< by a command; argument: the mode
  /// A command was damaged, repeated or stale; argument: how many so far.
  command_refused = 12,
  /// Somebody else sends with our identifiers; argument: frames so far.
  impersonated = 13,
  /// What it says cannot be; argument: 0 left wheel, 1 right wheel, 2 lidar, 3 gyro, 4
  /// accelerometer.
  sensor_doubted = 14,
  /// The watchdog ended the run before; argument: index of the task to blame, -1 for none.
  watchdog_reset = 15,
};

[[nodiscard]] const char* to_string(EventCode code);

/// 16 bytes, no padding, no constructor.
struct Event {
  std::int64_t stamp_us;  ///< on the monotonic clock of the run that wrote it
  std::int32_t argument;
  EventCode code;
  HealthState from;
  HealthState to;
  HealthReason reason;

  [[nodiscard]] Timestamp stamp() const { return Timestamp{Duration{stamp_us}}; }
};
static_assert(sizeof(Event) == 16);

/// Trivial on purpose: an instance in memory that start-up code leaves alone keeps its events over
/// a reset; `attach` tells such memory from random bytes. Cost: every call O(1), `attach` of random
/// bytes O(capacity). Context: cycle only.
class EventRing {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// To be called once after start, before anything else. True when events of an earlier run were
  /// found and kept.
  bool attach();
  void clear();
  /// The oldest event makes room.
  void push(const Event& event);

  [[nodiscard]] std::size_t size() const { return total_ < kCapacity ? total_ : kCapacity; }
  /// Index 0 is the oldest event held. Precondition: index < size().
  [[nodiscard]] const Event& operator[](std::size_t index) const;
  /// Events pushed since `clear`; saturates.
  [[nodiscard]] std::uint32_t total() const { return total_; }
  /// Events that made room for newer ones.
  [[nodiscard]] std::uint32_t overwritten() const {
    return total_ - static_cast<std::uint32_t>(size());
  }

 private:
  [[nodiscard]] std::uint32_t seal() const;

  std::array<Event, kCapacity> events_;
  std::uint32_t total_;
  std::uint32_t next_;
  std::uint32_t
      seal_;  // agrees with the two above unless memory is random or was torn by the reset
};
static_assert(std::is_trivially_default_constructible_v<EventRing> &&
              std::is_trivially_copyable_v<EventRing>);

}  // namespace picolo::inline v0
