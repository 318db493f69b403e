// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Calibration records that survive a loss of power at any byte: two slots in two sectors, written
/// in turns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/calibration/record.hpp"
#include "picolo/core/status.hpp"
#include "picolo/hal/byte_store.hpp"

namespace picolo::inline v0 {

/// The slot with the newest whole record counts; a save erases and programs the other one, its CRC
/// last, so until the last granule is in place the old record is what a restart loads. Context: one
/// at a time.
class CalibrationStore {
 public:
  /// Uses the two sectors that begin at `address` (the start of a sector).
  explicit CalibrationStore(ByteStore& medium, std::size_t address = 0)
      : medium_(medium), address_(address) {}

  /// The record of the last completed save. `not_ready`: blank, the record holds defaults.
  /// `corrupt`: neither slot is whole, defaults. `unsupported`: a newer version has written here;
  /// defaults, and nothing will be overwritten. `invalid_argument`: sectors too small or too few.
  /// `io_error`: the medium failed.
  /// Cost: reads two records.
  Status load(CalibrationRecord& record);

  /// Starts a save. Status as `load` where nothing can be stored; `full`: a save is under way.
  /// Cost: as `load`.
  Status begin_save(const CalibrationRecord& record);
  /// At most one erase, or `max_granules` granules. `ok`: saved and read back. `not_ready`: call
  /// again. `corrupt`: what was read back differs; the old record still counts. `io_error`: the
  /// medium failed; begin again.
  Status step(std::size_t max_granules);
  [[nodiscard]] bool saving() const { return phase_ != Phase::idle; }

 private:
  enum class Phase : std::uint8_t { idle, erase, program };
  struct Survey {
    CalibrationRecord record{};
    std::uint32_t sequence = 0;
    std::size_t newest = 1;  // slot; an empty store begins with slot 0
    bool found = false;
    bool blank = true;
    bool newer_version = false;
  };
  Status survey(Survey& result);
  [[nodiscard]] std::size_t slot_address(std::size_t slot) const;
  Status abandon(Status status);

  ByteStore& medium_;
  std::size_t address_;
  std::array<std::uint8_t, kCalibrationRecordSize> bytes_{};
  std::size_t slot_ = 0;
  std::size_t programmed_ = 0;
  Phase phase_ = Phase::idle;
};

}  // namespace picolo::inline v0
