// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The whole map of a drive: what the library's rolling window forgets is kept here, for pictures
/// and map files only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "picolo/geometry/pose2.hpp"
#include "picolo/host/map_file.hpp"
#include "picolo/map/rolling_map.hpp"

namespace picolo::host {

class MapMosaic {
 public:
  /// Call before every sweep with where the vehicle is: takes over the window when it is about to
  /// move. Cheap otherwise.
  void watch(const RollingMapCore& map, const Pose2d& map_T_base);
  /// Takes over every known cell of the window.
  void absorb(const RollingMapCore& map);
  /// Everything taken over so far, cropped, with a margin of unknown cells.
  [[nodiscard]] OccupancyImage image() const;

 private:
  static constexpr int kTile = 64;
  using Tile = std::array<MapCell, kTile * kTile>;

  std::map<std::pair<std::int32_t, std::int32_t>, Tile> tiles_;  // by column and row of tiles
  double cell_m_ = 0.05;
  Pose2d absorbed_at_{};
  bool absorbed_ = false;
};

}  // namespace picolo::host
