// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The map: occupancy in log-odds and the distance field that the matcher reads, in a window that
/// follows the vehicle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/map/grid_window.hpp"
#include "picolo/map/likelihood_field.hpp"

namespace picolo::inline v0 {

/// The window moves, and the field is repaired, in tiles of this size.
inline constexpr int kTileCells = 16;
inline constexpr int kMaxFieldRadius = 10;  ///< cells; the field's bytes are exact up to here

struct MapConfig {
  float cell_m = 0.05F;
  int field_radius_cells = 10;  ///< distances are truncated here
  /// Log-odds are in steps of the configuration's own making: only their ratios matter.
  std::int8_t hit = 40;
  std::int8_t miss = -10;
  std::int8_t low = -60;
  std::int8_t high = 100;
  std::int8_t occupied_from = 15;
  [[nodiscard]] constexpr bool valid() const {
    return cell_m > 0.0F && field_radius_cells >= 2 && field_radius_cells <= kMaxFieldRadius &&
           hit > 0 && miss < 0 && low < 0 && high > 0 && occupied_from > 0 && occupied_from <= high;
  }
};
static_assert(MapConfig{}.valid());

/// Work done so far; never reset, modulo 2^32. Times what each costs, it bounds the instructions of
/// a map update: see docs/targets.md.
struct MapWork {
  std::uint32_t ray_cells = 0;      ///< that rays walked over
  std::uint32_t changed_cells = 0;  ///< of which the log-odds changed
  std::uint32_t new_obstacles = 0;  ///< each paints the field around it
  std::uint32_t repaired_tiles = 0;
};

/// Spans over the storage of a `RollingMap`.
struct MapStorage {
  std::span<std::int8_t> occupancy;     ///< width * height, log-odds, 0 unknown
  std::span<std::uint8_t> field;        ///< width * height, see DistanceFieldView
  std::span<std::uint32_t> changed;     ///< one bit a cell: already changed by the current scan
  std::span<std::uint8_t> stale_tiles;  ///< one byte a tile: the field is to be repaired here
};

/// Occupancy after Moravec and Elfes (1985) with saturating integer log-odds; the distance field is
/// kept exact: a cell that becomes occupied paints its neighbourhood at once, a cell that becomes
/// free marks tiles that `repair` recomputes in bounded slices. Context: cycle only; readers of the
/// views see whole bytes at any time.
class RollingMapCore {
 public:
  /// Precondition: config.valid(), width and height multiples of kTileCells, storage of matching
  /// sizes.
  RollingMapCore(const MapConfig& config, int width, int height, const MapStorage& storage);

  /// Forgets everything and centres the window on the point.
  void reset(double centre_x_m, double centre_y_m);
  /// Moves the window by whole tiles when the point is further from its centre than a quarter of
  /// its size; what leaves is lost, what enters is unknown. True when the window moved. Cost: O(1),
  /// or one copy of the whole window.
  bool follow(double x_m, double y_m);

  /// Starts a scan: every cell changes at most once until the next call. Cost: O(cells / 32) over
  /// the rows that the last one touched.
  void begin_scan();
  /// One end of a beam, window coordinates; outside of the window it has no effect. Cost: O(1), or
  /// O(radius^2) for a new obstacle.
  void add_hit(Point2f window_p);
  /// Clears the cells from the lidar to `stop_cells` short of the end of the beam. Cost: O(width +
  /// height).
  void add_ray(Point2f window_lidar, Point2f window_p, int stop_cells);
  /// Recomputes the field of up to `max_tiles` stale tiles; returns how many it did. Cost: up to 12
  /// 000 instructions a tile.
  int repair(int max_tiles);
  [[nodiscard]] int stale_tiles() const { return stale_count_; }
  [[nodiscard]] const MapWork& work() const { return work_; }

  /// For maps that come from a store or a file: forgets everything and puts the window's lower left
  /// corner there; then `restore` what is known, then `mark_all_stale`, then `repair`.
  void place(std::int32_t origin_x_cells, std::int32_t origin_y_cells);
  /// Sets the log-odds of a row's cells from `column` on, clamped to the configuration's limits;
  /// the field stays as it is. What lies outside of the window has no effect. Cost: O(cells).
  void restore(int column, int row, std::span<const std::int8_t> log_odds);
  void mark_all_stale();

  /// Memory that only the scans entering the map need, an eighth of a byte a cell: to be used
  /// until the next `begin_scan`. Cost: O(cells / 32) at that call.
  [[nodiscard]] std::span<std::uint8_t> lend_scan_memory();

  [[nodiscard]] const GridWindow& window() const { return window_; }
  [[nodiscard]] const MapConfig& config() const { return config_; }
  [[nodiscard]] DistanceFieldView field() const;
  /// Log-odds, row-major from the lower left corner.
  [[nodiscard]] std::span<const std::int8_t> occupancy() const { return storage_.occupancy; }

 private:
  [[nodiscard]] std::size_t index_of(int column, int row) const;
  [[nodiscard]] bool mark_changed(int index);
  void touch_rows(int first, int last);
  void hit_cell(int column, int row);
  /// A line within the window: its extents, and what a step adds to the index of a cell.
  struct Line {
    int longer;
    int shorter;
    int along;
    int across;
  };
  void clear_line(const Line& line, int index, int steps);
  void clear_cell(int index);
  void lower_cell(int index);
  void paint(int column, int row);
  void mark_stale(int index);

  MapConfig config_;
  GridWindow window_;
  MapStorage storage_;
  float field_reach_m_ = 0.0F;
  float cells_per_m_ = 0.0F;
  std::array<std::uint8_t, kMaxFieldRadius * kMaxFieldRadius + 1>
      byte_of_square_{};       // squared cells -> field byte
  int first_changed_row_ = 0;  // of the current scan: what begin_scan has to forget
  int last_changed_row_ = -1;
  int stale_count_ = 0;
  std::size_t next_tile_ = 0;
  MapWork work_{};
};

/// Storage: 2 bytes and 1 bit a cell, 1 byte a tile.
template <int Width, int Height>
class RollingMap {
  static_assert(Width > 0 && Height > 0 && Width % kTileCells == 0 && Height % kTileCells == 0);
  static constexpr std::size_t kCells = static_cast<std::size_t>(Width) * Height;

 public:
  explicit RollingMap(const MapConfig& config = {})
      : core_(config, Width, Height, {occupancy_, field_, changed_, stale_tiles_}) {}
  RollingMap(const RollingMap&) = delete;
  RollingMap& operator=(const RollingMap&) = delete;
  ~RollingMap() = default;

  [[nodiscard]] RollingMapCore& core() { return core_; }
  [[nodiscard]] const RollingMapCore& core() const { return core_; }

 private:
  std::array<std::int8_t, kCells> occupancy_{};
  std::array<std::uint8_t, kCells> field_{};
  std::array<std::uint32_t, kCells / 32> changed_{};
  std::array<std::uint8_t, kCells / (kTileCells * kTileCells)> stale_tiles_{};
  RollingMapCore core_;
};

}  // namespace picolo::inline v0
