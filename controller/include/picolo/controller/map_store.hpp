// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Maps that survive a loss of power at any byte: two slots of whole sectors, written in turns, in
/// slices that fit into a cycle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/hal/byte_store.hpp"
#include "picolo/map/map_codec.hpp"

namespace picolo::inline v0 {

/// Where the two slots lie.
struct MapStoreConfig {
  std::size_t address = 0;    ///< start of a sector
  std::size_t slot_size = 0;  ///< whole sectors; 0: half of what the medium has from `address` on
};

/// A save streams the map into the slot that is not the newest, reads it back, and writes the
/// header last: until its last granule is in place the old map is what a restart loads. The map may
/// go on changing meanwhile. Context: one at a time, that of the map.
class MapStore {
 public:
  explicit MapStore(ByteStore& medium, const MapStoreConfig& config = {});

  /// Begins to load the newest whole map into `map`, which outlives the loading. It is read twice:
  /// `map` is untouched until all of it is known to be whole. `not_ready`: there
  /// is none; `corrupt`: headers, but none is whole; `unsupported`: a newer version has written
  /// here; `invalid_argument`: the slots do not fit the medium, or the stored map has other cells
  /// than this one; `full`: work is under way; `io_error`: the medium failed. Cost: reads two
  /// headers.
  Status begin_load(RollingMapCore& map);
  /// Begins to save. Status as `begin_load` where nothing can be stored. The map outlives the save.
  Status begin_save(const RollingMapCore& map);

  /// At most one erase, or `max_pieces` pieces of kPieceSize bytes, fewer when these cover more
  /// than kCellsPerStep cells. `not_ready`: call again; `ok`: done. Of a load, `corrupt`: neither
  /// slot is whole, the map is untouched; `io_error` may leave half a map. Of a save, `full`: the
  /// slot is too small; `out_of_range`: the map's window moved, begin again; `corrupt`: what was
  /// read back differs. `io_error`: the medium failed. After each of these the old map still
  /// counts.
  Status step(std::size_t max_pieces);
  [[nodiscard]] bool busy() const { return phase_ != Phase::idle; }
  /// Of the map loaded or saved last.
  [[nodiscard]] const MapHeader& header() const { return header_; }

  static constexpr std::size_t kPieceSize = 64;
  static constexpr std::size_t kCellsPerStep = 4096;

 private:
  enum class Phase : std::uint8_t { idle, write, verify, commit, load };
  struct Slot {
    MapHeader header{};
    Status status = Status::not_ready;
  };
  Status survey();
  Status abandon(Status status);
  Status load_piece();
  Status after_check();
  [[nodiscard]] bool needs_erased() const;
  [[nodiscard]] std::size_t cells_covered() const;
  Status write_piece();
  Status verify_piece();
  Status commit();
  Status start_checking(std::size_t slot);
  [[nodiscard]] std::size_t newest() const;
  [[nodiscard]] std::size_t slot_address(std::size_t slot) const {
    return address_ + slot * slot_size_;
  }

  ByteStore& medium_;
  std::size_t address_;
  std::size_t slot_size_;
  std::array<Slot, 2> slots_{};
  MapEncoder encoder_{};
  MapDecoder decoder_{};
  RollingMapCore* target_ = nullptr;
  MapHeader header_{};
  std::size_t slot_ = 0;
  std::size_t at_ = 0;      // bytes of the payload handled
  std::size_t erased_ = 0;  // bytes of the slot
  std::uint32_t crc_ = 0;
  bool second_try_ = false;
  Phase phase_ = Phase::idle;
};

}  // namespace picolo::inline v0
