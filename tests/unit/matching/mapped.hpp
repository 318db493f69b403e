// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Maps drawn from the walls of a test world.
#pragma once

#include <memory>
#include <vector>

#include "picolo/map/rolling_map.hpp"
#include "support/walls.hpp"

namespace picolo::test {

using SmallMap = RollingMap<320, 320>;

/// The map as a vehicle standing near the origin would draw it, from a few places.
inline std::unique_ptr<SmallMap> draw(const std::vector<Wall>& walls) {
  auto map = std::make_unique<SmallMap>();
  map->core().reset(0.0, 0.0);
  for (const Pose2d pose : {Pose2d{0, 0, 0}, Pose2d{1, 1, 1}, Pose2d{-1, -0.5, 2}}) {
    const Scan scan = scan_at(walls, pose, 1440);
    map->core().begin_scan();
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
      map->core().add_hit(
          transform(to_window(map->core().window(), pose), {scan.x_m[k], scan.y_m[k]}));
    }
  }
  return map;
}

}  // namespace picolo::test
