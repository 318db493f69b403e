// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Memory that survives power loss, with the manners of NOR flash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

struct ByteStoreGeometry {
  std::size_t size = 0;    ///< bytes in all; a multiple of `sector`
  std::size_t sector = 0;  ///< what `erase` erases
  std::size_t granule =
      1;  ///< `program` takes multiples of this, at multiples of this: 1, 2, 4, 8 or 16
};

/// NOR semantics: erased bytes read 0xFF; programming only clears bits; a granule is programmed
/// once after an erase (again: refused, or old AND new, never a set bit). Contents survive a reset.
/// A loss of power leaves at most the granule or sector in work undefined. Never blocks longer than
/// the port states for one granule or one sector. All calls from one context; empty spans are fine.
/// Ports are held to this by hal/conformance/byte_store.hpp.
class ByteStore {
 public:
  [[nodiscard]] virtual ByteStoreGeometry geometry() const = 0;
  /// `out_of_range`: beyond the size. `io_error`: the medium failed.
  virtual Status read(std::size_t address, std::span<std::uint8_t> bytes) = 0;
  /// `invalid_argument`: not aligned to granules. `out_of_range`, `io_error` as above. `not_ready`:
  /// an erase is under way, nothing was done; call again.
  virtual Status program(std::size_t address, std::span<const std::uint8_t> bytes) = 0;
  /// Erases the sector that starts at `address`. `invalid_argument`: not the start of a sector.
  /// `not_ready`: it has begun, or another one is under way; call again with the same address until
  /// `ok`, which a sector answers that is erased already. So does a port whose flash takes longer
  /// than a minor frame for a sector: in a cycle that waited, frames would slip. Meanwhile `read`
  /// of other sectors answers as ever.
  virtual Status erase(std::size_t address) = 0;

 protected:
  ByteStore() = default;
  ByteStore(const ByteStore&) = default;
  ByteStore& operator=(const ByteStore&) = default;
  ~ByteStore() = default;
};

}  // namespace picolo::inline v0
