// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "given_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "picolo/controller/map_store.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"
#include "picolo/sim/sim_byte_store.hpp"

namespace picolo::tool {
namespace {

using host::ExitCode;
using host::MapCell;
using host::OccupancyImage;
using host::UserError;

constexpr std::size_t kSector = 4096;
constexpr std::size_t kGranule = 8;
constexpr std::size_t kPieces = 1024;
constexpr double kRounding_m = 1e-6;  // of decimals in a YAML file

bool is_store(const std::string& bytes) {
  return bytes.size() >= 2 * kSector && bytes.size() % (2 * kSector) == 0 &&
         (bytes.starts_with("PMP1") || bytes.starts_with(std::string(kMapHeaderSize, '\xFF')));
}

Status finish(MapStore& store, Status begun) {
  Status status = begun;
  if (is_ok(status)) {
    do { status = store.step(kPieces); } while (status == Status::not_ready);
  }
  return status;
}

std::string size_text(int width, int height, double cell_m) {
  return fmt::format("{:.1f} m x {:.1f} m", width * cell_m, height * cell_m);
}

/// The source cells that a cell of the target covers, at least one.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};
Span covered(int cell, double ratio, std::size_t size) {
  constexpr double kEdge = 1e-6;
  const auto begin = static_cast<std::size_t>(std::floor(cell * ratio + kEdge));
  const auto end = static_cast<std::size_t>(std::ceil((cell + 1) * ratio - kEdge));
  return {std::min(begin, size - 1), std::min(std::max(end, begin + 1), size)};
}

MapCell cell_over(const OccupancyImage& image, const Span& columns, const Span& rows) {
  MapCell cell = MapCell::unknown;
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    for (std::size_t column = columns.begin; column < columns.end; ++column) {
      const MapCell seen = image.at(column, row);
      if (seen == MapCell::occupied) { return seen; }
      if (seen == MapCell::free) { cell = seen; }
    }
  }
  return cell;
}

}  // namespace

GivenMap::GivenMap(const std::filesystem::path& path) : path_{path} {
  if (is_store(host::read_file(path))) { return; }
  image_ = crop(host::read_map(path), 0);
  if (std::ranges::find(image_->cells, MapCell::occupied) == image_->cells.end()) {
    throw UserError{ExitCode::input, path.string(), "its map has no occupied cell",
                    "check negate, mode and the thresholds"};
  }
}

Pose2d GivenMap::restore(RollingMapCore& map, const char* profile) const {
  return image_ ? restore_image(map, profile) : restore_store(map, profile);
}

Pose2d GivenMap::restore_image(RollingMapCore& map, const char* profile) const {
  const GridWindow& window = map.window();
  // 0.05, not 0.05000000074505806 as a float has it: cells are to fall on cells
  const double cell_m = std::round(static_cast<double>(window.cell_m) / kRounding_m) * kRounding_m;
  const double ratio = std::round(1e9 * cell_m / image_->resolution_m) / 1e9;
  const auto cells = [&](std::size_t count) {
    return static_cast<int>(std::ceil(static_cast<double>(count) / ratio - 1e-6));
  };
  const int width = cells(image_->width);
  const int height = cells(image_->height);
  if (width > window.width || height > window.height) {
    throw UserError{ExitCode::refused, path_.string(),
                    fmt::format("the known part of its map is {}, but profile {} holds {}",
                                size_text(width, height, cell_m), profile,
                                size_text(window.width, window.height, cell_m)),
                    "choose a larger one with --profile, or cut the map"};
  }
  const auto corner_x = static_cast<int>(std::lround(image_->origin_x_m / cell_m));
  const auto corner_y = static_cast<int>(std::lround(image_->origin_y_m / cell_m));
  const int left = (window.width - width) / 2;
  const int low = (window.height - height) / 2;
  map.place(corner_x - left, corner_y - low);
  std::vector<std::int8_t> line(static_cast<std::size_t>(width));
  for (int row = 0; row < height; ++row) {
    const Span rows = covered(row, ratio, image_->height);
    for (int column = 0; column < width; ++column) {
      const MapCell cell = cell_over(*image_, covered(column, ratio, image_->width), rows);
      std::int8_t& value = line[static_cast<std::size_t>(column)];
      value = 0;
      if (cell == MapCell::occupied) { value = map.config().high; }
      if (cell == MapCell::free) { value = map.config().low; }
    }
    map.restore(left, low + row, line);
  }
  const auto rest = [cell_m](double origin_m, int corner) {
    const double rest_m = origin_m - corner * cell_m;
    return std::abs(rest_m) < kRounding_m ? 0.0 : rest_m;
  };
  return {rest(image_->origin_x_m, corner_x), rest(image_->origin_y_m, corner_y), 0.0};
}

Pose2d GivenMap::restore_store(RollingMapCore& map, const char* profile) const {
  const std::string bytes = host::read_file(path_);
  std::vector<std::uint8_t> memory(bytes.size());
  sim::SimByteStore medium{memory, kSector, kGranule};
  std::ranges::copy(bytes, memory.begin());
  MapStore store{medium};
  const Status status = finish(store, store.begin_load(map));
  if (status == Status::ok) { return {}; }
  if (status == Status::invalid_argument) {
    throw UserError{ExitCode::refused, path_.string(),
                    fmt::format("its map has other cells than those of profile {} ({:.3f} m)",
                                profile, static_cast<double>(map.config().cell_m)),
                    "choose the profile it was saved with"};
  }
  throw UserError{ExitCode::input, path_.string(),
                  fmt::format("holds no whole map ({})", to_string(status)),
                  "save it again, or give the map.yaml beside it"};
}

void save_map(const RollingMapCore& map, const std::filesystem::path& path) {
  // At worst a byte in 128 more than the cells.
  const std::size_t cells = map.occupancy().size();
  const std::size_t slot = (kMapHeaderSize + cells + cells / 64 + 2 * kSector) / kSector * kSector;
  std::vector<std::uint8_t> memory(2 * slot);
  sim::SimByteStore medium{memory, kSector, kGranule};
  MapStore store{medium};
  const Status status = finish(store, store.begin_save(map));
  if (!is_ok(status)) {
    throw UserError{ExitCode::device, path.string(),
                    fmt::format("the map could not be stored: {}", to_string(status)), ""};
  }
  // Shortened to what this map needs, so that the file is as small as the flash could be.
  const std::size_t used =
      (kMapHeaderSize + store.header().payload_bytes + MapStore::kPieceSize + kSector - 1) /
      kSector * kSector;
  std::string content(2 * used, '\xFF');
  std::copy_n(memory.begin(), used, content.begin());
  host::write_file(path, content);
}

}  // namespace picolo::tool
