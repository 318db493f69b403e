// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A map as bytes: a header with version and checksums, then the window's log-odds, run-length
/// coded, in slices of any size. Layout in docs/maps.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/core/status.hpp"
#include "picolo/map/rolling_map.hpp"

namespace picolo::inline v0 {

inline constexpr std::uint16_t kMapFormatVersion = 1;
inline constexpr std::size_t kMapHeaderSize = 64;

struct MapHeader {
  std::uint32_t sequence = 0;  ///< of the saves; the newer of two slots has the higher, modulo 2^32
  GridWindow window{};
  std::int8_t occupied_from = 0;  ///< log-odds from which a cell is an obstacle
  std::uint32_t payload_bytes = 0;
  std::uint32_t payload_crc = 0;  ///< crc32
};

void encode_map_header(const MapHeader& header, std::span<std::uint8_t, kMapHeaderSize> bytes);
/// `not_ready`: erased or too short; `unsupported`: a newer version; `corrupt`: anything else that
/// is no header. `header` is set when `ok`.
Status decode_map_header(ByteView bytes, MapHeader& header);

/// Payload: row by row from the lower left corner, without regard to the ends of rows, tokens
/// 0..127 n: n + 1 values follow; 128..255 n, then m: the next value stands (n - 128) * 256 + m + 4
/// times. At most 1 byte in 128 longer than the cells. Cells may change between two calls (each
/// token is consistent in itself), the window must not move. Context: that of the map.
class MapEncoder {
 public:
  /// The map outlives the encoding.
  void begin(const RollingMapCore& map);
  /// Fills `out` as far as there is something left; returns the number of bytes written, 0 at the
  /// end. Cost: O(cells covered), at most a 64th of the map for 3 bytes.
  [[nodiscard]] std::size_t encode(std::span<std::uint8_t> out);
  /// The map's window is no longer the one of `begin`: what was written is worthless.
  [[nodiscard]] bool window_moved() const { return !(map_->window() == window_); }
  [[nodiscard]] const GridWindow& window() const { return window_; }
  [[nodiscard]] std::size_t cells_covered() const { return cell_; }

 private:
  void next_token();
  [[nodiscard]] std::size_t run_at(std::size_t cell, std::size_t longest) const;

  const RollingMapCore* map_ = nullptr;
  GridWindow window_{};
  std::array<std::uint8_t, 3> head_{};  // of the token that is being written
  std::size_t head_size_ = 0;
  std::size_t head_written_ = 0;
  std::size_t literals_ = 0;  // of it that follow the head
  std::size_t cell_ = 0;
};

/// The other way round, bytes in pieces of any size. Context: that of the map.
class MapDecoder {
 public:
  /// Same cell size, same limit of what is an obstacle.
  [[nodiscard]] static bool fits(const MapHeader& header, const RollingMapCore& target);
  /// Places the target's window: as the header says when the sizes are equal, otherwise so that the
  /// centres agree; cells outside of it are left out. The target outlives the decoding.
  /// `invalid_argument`: it does not fit.
  Status begin(const MapHeader& header, RollingMapCore& target);
  /// `ok`: go on, or `complete`. `corrupt`: no such tokens, or more cells than the window has.
  /// Cost: O(cells covered).
  Status decode(ByteView bytes);
  [[nodiscard]] bool complete() const { return cell_ == cells_; }
  [[nodiscard]] std::size_t cells_covered() const { return cell_; }

 private:
  enum class Expect : std::uint8_t { token, length, value, literal };
  Status put(std::uint8_t byte);
  void fill(std::int8_t value, std::size_t count);

  RollingMapCore* target_ = nullptr;
  int width_ = 0;
  int shift_x_ = 0;  // from the saved window to the target's
  int shift_y_ = 0;
  std::size_t cells_ = 0;
  std::size_t cell_ = 0;
  std::size_t count_ = 0;  // of the present token
  Expect expect_ = Expect::token;
};

/// Log-odds of a coarser grid from those of a finer one: a coarse cell is as occupied as its most
/// occupied known cell. Precondition: the coarse cell size is a whole multiple of the fine one's.
/// Begins with `place_coarse`, then rows of the coarse grid in any order. Cost of a row: its fine
/// cells.
void place_coarse(const RollingMapCore& fine, RollingMapCore& coarse);
void restore_coarse_row(const RollingMapCore& fine, RollingMapCore& coarse, int row);

}  // namespace picolo::inline v0
