// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One revolution of the lidar, and the assembler that cuts the stream of readings into
/// revolutions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/status.hpp"
#include "picolo/core/time.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

/// A view of a sweep; valid for the cycle in which it was handed out.
struct Sweep {
  Timestamp stamp{};           ///< of the first return
  Timestamp last_stamp{};      ///< of the last return
  std::uint32_t sequence = 0;  ///< counts complete sweeps since start; a gap means replaced sweeps
  std::span<const RangeReturn> returns{};  ///< in the order of measurement
};

struct SweepCounters {
  std::uint32_t completed = 0;
  std::uint32_t replaced = 0;      ///< complete but not taken before the next one was complete
  std::uint32_t overflowed = 0;    ///< readings beyond the capacity, dropped
  std::uint32_t out_of_order = 0;  ///< readings older than their predecessor
  std::uint32_t partial = 0;       ///< revolutions dropped: begun unseen, interrupted, too short
};

struct SweepAssemblerConfig {
  /// A silence longer than this inside of a revolution drops the revolution, and so do stamps that
  /// fall back by more than this.
  Duration max_gap = 50ms;
  /// A revolution with fewer readings than this is dropped as partial.
  int min_readings = 16;
  [[nodiscard]] constexpr bool valid() const { return max_gap > Duration{0} && min_readings > 0; }
};

/// The logic behind `SweepAssembler`, over storage it does not own: two buffers, one filling, one
/// complete.
/// Cost: `add` O(1). Context: cycle only.
class SweepAssemblerCore {
 public:
  SweepAssemblerCore(const SweepAssemblerConfig& config, std::span<RangeReturn> first,
                     std::span<RangeReturn> second);

  /// Takes the next reading. `ends_sweep` completes its revolution, and so does `starts_sweep` the
  /// one before it. A revolution whose
  /// beginning was not seen is dropped, and so is a reading older than its predecessor; but one
  /// that starts a sweep starts it whatever its stamp.
  void add(const RangeReading& reading);
  /// True when a complete sweep waits.
  [[nodiscard]] bool ready() const { return ready_; }
  /// The waiting sweep; it stays valid until the next call of `add` that completes another one.
  /// Precondition: ready(). Afterwards not ready.
  [[nodiscard]] Sweep take();
  [[nodiscard]] const SweepCounters& counters() const { return counters_; }

 private:
  void begin(const RangeReading& reading);
  void store(const RangeReading& reading);
  void complete();
  void drop();

  SweepAssemblerConfig config_;
  std::array<std::span<RangeReturn>, 2> buffers_;
  std::array<Sweep, 2> sweeps_{};
  std::size_t filling_ = 0;
  std::size_t size_ = 0;
  Timestamp last_stamp_{};
  bool in_sweep_ = false;
  bool dropped_ = false;  // the revolution that passes now is counted as partial already
  bool ready_ = false;
  SweepCounters counters_{};
};

/// Storage for sweeps of up to `Capacity` returns: 24 bytes a return.
template <std::size_t Capacity>
class SweepAssembler {
 public:
  explicit SweepAssembler(const SweepAssemblerConfig& config = {})
      : core_(config, first_, second_) {}
  SweepAssembler(const SweepAssembler&) = delete;
  SweepAssembler& operator=(const SweepAssembler&) = delete;
  ~SweepAssembler() = default;

  void add(const RangeReading& reading) { core_.add(reading); }
  [[nodiscard]] bool ready() const { return core_.ready(); }
  [[nodiscard]] Sweep take() { return core_.take(); }
  [[nodiscard]] const SweepCounters& counters() const { return core_.counters(); }

 private:
  std::array<RangeReturn, Capacity> first_{};
  std::array<RangeReturn, Capacity> second_{};
  SweepAssemblerCore core_;
};

}  // namespace picolo::inline v0
