// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A room with furniture, its map, and scans of it: ground for the searches.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::test {

struct Wall {
  double x0, y0, x1, y1;
};

/// 10 m x 7 m around the map's origin, with an alcove, a pillar and a cupboard: no symmetry.
inline std::vector<Wall> room() {
  return {{-5, -3.5, 5, -3.5}, {5, -3.5, 5, 3.5},      {5, 3.5, 1, 3.5},     {1, 3.5, 1, 2.5},
          {1, 2.5, -1.5, 2.5}, {-1.5, 2.5, -1.5, 3.5}, {-1.5, 3.5, -5, 3.5}, {-5, 3.5, -5, -3.5},
          {2, -1, 2.6, -1},    {2.6, -1, 2.6, -0.4},   {2.6, -0.4, 2, -0.4}, {2, -0.4, 2, -1},
          {-3, -3.5, -3, -2},  {-3, -2, -4, -2}};
}

/// Distance along the beam to the first wall; 0 when there is none.
inline double cast(const std::vector<Wall>& walls, const Pose2d& map_T_lidar, double bearing_rad) {
  const double angle = map_T_lidar.theta_rad + bearing_rad;
  const double dx = std::cos(angle);
  const double dy = std::sin(angle);
  double nearest = 0.0;
  for (const Wall& wall : walls) {
    const double wx = wall.x1 - wall.x0;
    const double wy = wall.y1 - wall.y0;
    const double cross = dx * wy - dy * wx;
    if (std::abs(cross) < 1e-12) { continue; }
    const double ox = wall.x0 - map_T_lidar.x_m;
    const double oy = wall.y0 - map_T_lidar.y_m;
    const double range = (ox * wy - oy * wx) / cross;
    const double share = (ox * dy - oy * dx) / cross;
    if (range > 1e-6 && share >= 0.0 && share <= 1.0 && (nearest == 0.0 || range < nearest)) {
      nearest = range;
    }
  }
  return nearest;
}

/// Points of one scan in base, with Gaussian noise.
struct Scan {
  std::vector<float> x_m;
  std::vector<float> y_m;
  [[nodiscard]] PointsView view() const { return {x_m, y_m}; }
};

inline Scan scan_from(const std::vector<Wall>& walls, const Pose2d& map_T_base, int beams,
                      double noise_m, Random& random) {
  Scan scan;
  for (int k = 0; k < beams; ++k) {
    const double bearing = -3.14159265358979 + 6.28318530717959 * k / beams;
    const double range = cast(walls, map_T_base, bearing);
    if (range == 0.0) { continue; }
    const double noisy = range + noise_m * random.gaussian();
    scan.x_m.push_back(static_cast<float>(noisy * std::cos(bearing)));
    scan.y_m.push_back(static_cast<float>(noisy * std::sin(bearing)));
  }
  return scan;
}

/// A map of 12.8 m with every wall drawn in.
template <int Cells = 256>
inline std::unique_ptr<RollingMap<Cells, Cells>> map_of(const std::vector<Wall>& walls,
                                                        const MapConfig& config = {}) {
  auto map = std::make_unique<RollingMap<Cells, Cells>>(config);
  const GridWindow& window = map->core().window();
  map->core().begin_scan();
  for (const Wall& wall : walls) {
    const double length = std::hypot(wall.x1 - wall.x0, wall.y1 - wall.y0);
    const int steps = static_cast<int>(length / 0.01);
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const Pose2d at{wall.x0 + share * (wall.x1 - wall.x0), wall.y0 + share * (wall.y1 - wall.y0),
                      0.0};
      const Pose2f in_window = to_window(window, at);
      map->core().add_hit({in_window.x_m, in_window.y_m});
    }
  }
  return map;
}

}  // namespace picolo::test
