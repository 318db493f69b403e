// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The kernel's stamps of received data, brought to the monotonic clock.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/sensing/device_clock.hpp"

struct msghdr;

namespace picolo::inline v0 {

/// What the kernel knows about one datagram; 0: nothing.
struct KernelStamps {
  std::int64_t hardware_ns = 0;  ///< by the controller, on a clock of its own
  std::int64_t realtime_ns = 0;  ///< by the kernel, in wall time
};

/// From the control messages of a datagram (SO_TIMESTAMPNS, SO_TIMESTAMPING).
[[nodiscard]] KernelStamps kernel_stamps(msghdr& message);

struct MappedStamp {
  Timestamp stamp{};
  StampSource source = StampSource::read;
};

/// Hardware before kernel before the time of the read. Wall time is mapped by the offset between
/// both clocks that is measured for each drain (the reads up to an empty queue). A datagram must
/// have come between the end of the previous drain and now, which shows steps of the wall clock
/// beyond a millisecond; data that came before such a step fits the previous drain's offset, and
/// keeps its stamp. Hardware stamps go through a minimum filter against the kernel's.
/// Cost: O(1). Context: one at a time.
class StampMapper {
 public:
  /// Something has been opened: nothing waits yet that is older than `now`.
  void reset(Timestamp now);
  /// Before the first read of a drain, and again when `map` asks for it by `wants_offset`.
  void begin_drain(std::int64_t realtime_minus_monotonic_ns);
  void end_drain(Timestamp now);
  [[nodiscard]] bool draining() const { return draining_; }
  /// True when the stamp fits neither offset: the wall clock was stepped within this drain.
  [[nodiscard]] bool wants_offset(const KernelStamps& stamps, Timestamp now) const;
  /// Never decreases, never after `now`.
  [[nodiscard]] MappedStamp map(const KernelStamps& stamps, Timestamp now);

  /// Steps of the wall clock that were seen; never reset.
  [[nodiscard]] std::uint32_t clock_steps() const { return clock_steps_; }
  /// Data whose stamp fitted no offset, and that got the time of the read; never reset.
  [[nodiscard]] std::uint32_t misfits() const { return misfits_; }

 private:
  [[nodiscard]] bool fits(std::int64_t realtime_ns, std::int64_t offset_ns, Timestamp now) const;
  [[nodiscard]] MappedStamp map_realtime(std::int64_t realtime_ns, Timestamp now);

  // A clock that counts nanoseconds without wrapping, and does not jump without a reset.
  DeviceClock hardware_{{.wrap = Duration{100'000'000'000'000'000},
                         .resolution = 1us,
                         .window = 200ms,
                         .max_drift_ppm = 50,
                         .max_lateness = 200ms}};
  std::int64_t offset_ns_ = 0;           ///< realtime minus monotonic, of this drain
  std::int64_t previous_offset_ns_ = 0;  ///< before the last step
  Timestamp previous_end_{};             ///< when the queue was last seen empty
  Timestamp last_{};
  std::uint32_t clock_steps_ = 0;
  std::uint32_t misfits_ = 0;
  bool draining_ = false;
  bool has_offset_ = false;
};

/// Realtime minus monotonic now, in nanoseconds.
[[nodiscard]] std::int64_t realtime_minus_monotonic_ns();

}  // namespace picolo::inline v0
