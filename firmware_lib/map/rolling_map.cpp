// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/rolling_map.hpp"

#include <algorithm>

#include "grid_shift.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/convert_inline.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "tile_field.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kFarAway = 255;
constexpr int kCellLimit = 1 << 20;  // far beyond every window, small enough for int arithmetic

/// Whole tiles between the window's centre and the cell, when that is more than a quarter of the
/// window; otherwise 0.
int tiles_to_move(int cell_from_corner, int size) {
  const int from_centre = cell_from_corner - size / 2;
  if (from_centre <= size / 4 && from_centre >= -size / 4) { return 0; }
  return from_centre / kTileCells;
}

/// floor_to_i32, at once for what lies inside of the window.
int cell_at(float in_cells) {
  const bool usual = in_cells >= 0.0F && in_cells < static_cast<float>(kCellLimit);
  return usual ? truncate_bounded(in_cells) : floor_to_i32(in_cells, -kCellLimit, kCellLimit);
}

}  // namespace

RollingMapCore::RollingMapCore(const MapConfig& config, int width, int height,
                               const MapStorage& storage)
    : config_(config), window_{width, height, config.cell_m, 0, 0}, storage_(storage) {
  const int radius = config_.field_radius_cells;
  field_reach_m_ = static_cast<float>(radius) * config_.cell_m;
  cells_per_m_ = 1.0F / config_.cell_m;
  for (int square = 0; square <= radius * radius; ++square) {
    const float share = square_root(static_cast<float>(square)) / static_cast<float>(radius);
    byte_of_square_[static_cast<std::size_t>(square)] =
        static_cast<std::uint8_t>(round_to_i32(255.0F * share, 0, kFarAway));
  }
  reset(0.0, 0.0);
}

void RollingMapCore::reset(double centre_x_m, double centre_y_m) {
  const auto cell = static_cast<double>(config_.cell_m);
  place(floor_to_i32(centre_x_m / cell, -kCellLimit, kCellLimit) - window_.width / 2,
        floor_to_i32(centre_y_m / cell, -kCellLimit, kCellLimit) - window_.height / 2);
}

void RollingMapCore::place(std::int32_t origin_x_cells, std::int32_t origin_y_cells) {
  window_.origin_x_cells = origin_x_cells;
  window_.origin_y_cells = origin_y_cells;
  std::fill(storage_.occupancy.begin(), storage_.occupancy.end(), std::int8_t{0});
  std::fill(storage_.field.begin(), storage_.field.end(), kFarAway);
  std::fill(storage_.changed.begin(), storage_.changed.end(), 0U);
  std::fill(storage_.stale_tiles.begin(), storage_.stale_tiles.end(), std::uint8_t{0});
  stale_count_ = 0;
  next_tile_ = 0;
  first_changed_row_ = window_.height;
  last_changed_row_ = -1;
}

bool RollingMapCore::follow(double x_m, double y_m) {
  const auto cell = static_cast<double>(config_.cell_m);
  const int dx = tiles_to_move(
      floor_to_i32(x_m / cell, -kCellLimit, kCellLimit) - window_.origin_x_cells, window_.width);
  const int dy = tiles_to_move(
      floor_to_i32(y_m / cell, -kCellLimit, kCellLimit) - window_.origin_y_cells, window_.height);
  if (dx == 0 && dy == 0) { return false; }
  shift_grid(storage_.occupancy, window_.width, window_.height, dx * kTileCells, dy * kTileCells,
             std::int8_t{0});
  shift_grid(storage_.field, window_.width, window_.height, dx * kTileCells, dy * kTileCells,
             kFarAway);
  shift_grid(storage_.stale_tiles, window_.width / kTileCells, window_.height / kTileCells, dx, dy,
             std::uint8_t{0});
  stale_count_ =
      static_cast<int>(std::count(storage_.stale_tiles.begin(), storage_.stale_tiles.end(), 1));
  window_.origin_x_cells += dx * kTileCells;
  window_.origin_y_cells += dy * kTileCells;
  return true;
}

void RollingMapCore::restore(int column, int row, std::span<const std::int8_t> log_odds) {
  if (row < 0 || row >= window_.height) { return; }
  for (const std::int8_t value : log_odds) {
    if (column >= 0 && column < window_.width) {
      storage_.occupancy[index_of(column, row)] = std::clamp(value, config_.low, config_.high);
    }
    ++column;
  }
}

void RollingMapCore::mark_all_stale() {
  std::fill(storage_.stale_tiles.begin(), storage_.stale_tiles.end(), std::uint8_t{1});
  stale_count_ = static_cast<int>(storage_.stale_tiles.size());
}

DistanceFieldView RollingMapCore::field() const {
  return {storage_.field.data(), window_.width, window_.height, cells_per_m_, field_reach_m_};
}

std::size_t RollingMapCore::index_of(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.width) +
         static_cast<std::size_t>(column);
}

std::span<std::uint8_t> RollingMapCore::lend_scan_memory() {
  first_changed_row_ = 0;
  last_changed_row_ = window_.height - 1;
  void* const bytes = storage_.changed.data();
  return {static_cast<std::uint8_t*>(bytes), storage_.changed.size_bytes()};
}

void RollingMapCore::begin_scan() {
  if (last_changed_row_ >= first_changed_row_) {
    const std::size_t first = index_of(0, first_changed_row_) / 32;
    const std::size_t end = (index_of(0, last_changed_row_ + 1) + 31) / 32;
    std::fill(storage_.changed.begin() + static_cast<std::ptrdiff_t>(first),
              storage_.changed.begin() + static_cast<std::ptrdiff_t>(end), 0U);
  }
  first_changed_row_ = window_.height;
  last_changed_row_ = -1;
}

void RollingMapCore::touch_rows(int first, int last) {
  first_changed_row_ = std::min(first_changed_row_, first);
  last_changed_row_ = std::max(last_changed_row_, last);
}

// The first change of a cell in this scan?
bool RollingMapCore::mark_changed(int index) {
  std::uint32_t& word = storage_.changed[static_cast<std::size_t>(index) / 32];
  const std::uint32_t bit = 1U << (static_cast<std::uint32_t>(index) % 32U);
  if ((word & bit) != 0) { return false; }
  word |= bit;
  return true;
}

void RollingMapCore::hit_cell(int column, int row) {
  const int index = row * window_.width + column;
  touch_rows(row, row);
  if (!mark_changed(index)) { return; }
  ++work_.changed_cells;
  std::int8_t& cell = storage_.occupancy[static_cast<std::size_t>(index)];
  const bool was_occupied = cell >= config_.occupied_from;
  cell = static_cast<std::int8_t>(std::min<int>(cell + config_.hit, config_.high));
  if (cell >= config_.occupied_from && !was_occupied) { paint(column, row); }
}

void RollingMapCore::clear_cell(int index) {
  if (mark_changed(index)) { lower_cell(index); }
}

// Out of line: it is the rare case of the loops that call it.
[[gnu::noinline]] void RollingMapCore::lower_cell(int index) {
  ++work_.changed_cells;
  std::int8_t& cell = storage_.occupancy[static_cast<std::size_t>(index)];
  const int before = cell;
  const int after = std::max<int>(before + config_.miss, config_.low);
  cell = static_cast<std::int8_t>(after);
  if (before >= config_.occupied_from && after < config_.occupied_from) { mark_stale(index); }
}

void RollingMapCore::paint(int column, int row) {
  ++work_.new_obstacles;
  const int radius = config_.field_radius_cells;
  int half = radius;  // of the circle's line that is at hand
  for (int dy = 0; dy < radius; ++dy) {
    while (half * half + dy * dy >= radius * radius) { --half; }
    const int first = std::max(0, column - half) - column;
    const int last = std::min(window_.width - 1, column + half) - column;
    const std::uint8_t* const bytes = byte_of_square_.data() + dy * dy;
    for (const int y : {row - dy, row + dy}) {
      if (y < 0 || y >= window_.height) { continue; }
      std::uint8_t* const line = storage_.field.data() + y * window_.width + column;
      for (int dx = first; dx <= last; ++dx) { line[dx] = std::min(line[dx], bytes[dx * dx]); }
    }
  }
}

[[gnu::noinline]] void RollingMapCore::mark_stale(int index) {
  const int column = index % window_.width;
  const int row = index / window_.width;
  const int radius = config_.field_radius_cells;
  const int tiles_across = window_.width / kTileCells;
  const int last_column = std::min(window_.width - 1, column + radius) / kTileCells;
  const int last_row = std::min(window_.height - 1, row + radius) / kTileCells;
  for (int y = std::max(0, row - radius) / kTileCells; y <= last_row; ++y) {
    for (int x = std::max(0, column - radius) / kTileCells; x <= last_column; ++x) {
      std::uint8_t& stale = storage_.stale_tiles[static_cast<std::size_t>(y * tiles_across + x)];
      stale_count_ += 1 - stale;
      stale = 1;
    }
  }
}

void RollingMapCore::add_hit(Point2f window_p) {
  const int column = cell_at(window_p.x_m * cells_per_m_);
  const int row = cell_at(window_p.y_m * cells_per_m_);
  if (column < 0 || row < 0 || column >= window_.width || row >= window_.height) { return; }
  hit_cell(column, row);
}

void RollingMapCore::add_ray(Point2f window_lidar, Point2f window_p, int stop_cells) {
  int column = cell_at(window_lidar.x_m * cells_per_m_);
  int row = cell_at(window_lidar.y_m * cells_per_m_);
  const int to_column = cell_at(window_p.x_m * cells_per_m_);
  const int to_row = cell_at(window_p.y_m * cells_per_m_);
  const auto inside = [this](int x, int y) {
    return x >= 0 && y >= 0 && x < window_.width && y < window_.height;
  };
  // Bresenham's line, all octants; it ends at the window's edge, since the lidar stands inside.
  const int dx = to_column > column ? to_column - column : column - to_column;
  const int dy = to_row > row ? to_row - row : row - to_row;
  const int step_x = to_column > column ? 1 : -1;
  const int step_y = to_row > row ? 1 : -1;
  const int steps = std::max(0, std::max(dx, dy) - stop_cells);
  work_.ray_cells += static_cast<std::uint32_t>(steps);
  touch_rows(std::clamp(std::min(row, to_row), 0, window_.height - 1),
             std::clamp(std::max(row, to_row), 0, window_.height - 1));
  if (inside(column, row) && inside(to_column, to_row)) {
    const int next_row = step_y * window_.width;
    const Line line = dx >= dy ? Line{dx, dy, step_x, next_row} : Line{dy, dx, next_row, step_x};
    clear_line(line, static_cast<int>(index_of(column, row)), steps);
    return;
  }
  int error = dx - dy;
  for (int i = 0; i < steps && inside(column, row); ++i) {
    const std::size_t index = index_of(column, row);
    if (storage_.occupancy[index] > config_.low) { clear_cell(static_cast<int>(index)); }
    const int twice = 2 * error;
    if (twice > -dy) {
      error -= dy;
      column += step_x;
    }
    if (twice < dx) {
      error += dx;
      row += step_y;
    }
  }
}

// The same cells as the loop above, which steps along the longer axis every time.
void RollingMapCore::clear_line(const Line& line, int index, int steps) {
  const std::int8_t* const cells = storage_.occupancy.data();
  std::uint32_t* const changed = storage_.changed.data();
  const int low = config_.low;
  const Line at = line;
  int error = at.longer - at.shorter;
  for (; steps > 0; --steps) {
    // Most of free space is as free as it gets: nothing to change, and no hit comes after the rays.
    if (cells[index] > low) {
      const std::uint32_t bit = 1U << (static_cast<std::uint32_t>(index) % 32U);
      const std::uint32_t word = changed[index >> 5];
      if ((word & bit) == 0) {
        changed[index >> 5] = word | bit;
        lower_cell(index);
      }
    }
    const bool diagonal = 2 * error < at.longer;
    error -= at.shorter;
    index += at.along;
    if (diagonal) {
      error += at.longer;
      index += at.across;
    }
  }
}

int RollingMapCore::repair(int max_tiles) {
  const std::size_t tiles = storage_.stale_tiles.size();
  const int tiles_across = window_.width / kTileCells;
  const int radius = config_.field_radius_cells;
  int done = 0;
  for (std::size_t looked_at = 0; looked_at < tiles && stale_count_ > 0 && done < max_tiles;
       ++looked_at) {
    const std::size_t tile = next_tile_;
    next_tile_ = next_tile_ + 1 == tiles ? 0 : next_tile_ + 1;
    if (storage_.stale_tiles[tile] == 0) { continue; }
    storage_.stale_tiles[tile] = 0;
    --stale_count_;
    ++done;
    ++work_.repaired_tiles;
    compute_tile_field({.occupancy = storage_.occupancy.data(),
                        .field = storage_.field.data(),
                        .width = window_.width,
                        .height = window_.height,
                        .column = static_cast<int>(tile) % tiles_across * kTileCells,
                        .row = static_cast<int>(tile) / tiles_across * kTileCells,
                        .radius = radius,
                        .occupied_from = config_.occupied_from,
                        .byte_of_square = std::span{byte_of_square_}.first(
                            static_cast<std::size_t>(radius * radius) + 1)});
  }
  return done;
}

}  // namespace picolo::inline v0
