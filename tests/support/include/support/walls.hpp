// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A small world of walls for tests: exact ray casting in double, no part of the shipped
/// simulation.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::test {

struct Wall {
  double x0_m, y0_m, x1_m, y1_m;
};

/// A room of 8 m x 6 m around the origin with a pillar and a niche, so that every direction is
/// constrained; turned by 0.1 rad, so that no wall lies along a row of cells.
inline std::vector<Wall> furnished_room() {
  std::vector<Wall> walls{{-4, -3, 4, -3},      {4, -3, 4, 3},        {4, 3, 1, 3},
                          {1, 3, 1, 2.2},       {1, 2.2, 0, 2.2},     {0, 2.2, 0, 3},
                          {0, 3, -4, 3},        {-4, 3, -4, -3},      {2, -1, 2.5, -1},
                          {2.5, -1, 2.5, -0.5}, {2.5, -0.5, 2, -0.5}, {2, -0.5, 2, -1}};
  const Pose2d turn{0.0, 0.0, 0.1};
  for (Wall& wall : walls) {
    const Point2<double> from = transform(turn, Point2<double>{wall.x0_m, wall.y0_m});
    const Point2<double> to = transform(turn, Point2<double>{wall.x1_m, wall.y1_m});
    wall = {from.x_m, from.y_m, to.x_m, to.y_m};
  }
  return walls;
}

/// Two parallel walls, 2 m apart, without ends in sight.
inline std::vector<Wall> endless_corridor() {
  return {{-500, -1.025, 500, -1.025}, {-500, 1.025, 500, 1.025}};
}

/// Distance along the ray, or 0 when it meets nothing within 29 m.
inline double cast(const std::vector<Wall>& walls, double x_m, double y_m, double bearing_rad) {
  const double dx = std::cos(bearing_rad);
  const double dy = std::sin(bearing_rad);
  double nearest = 29.0;
  for (const Wall& wall : walls) {
    const double wx = wall.x1_m - wall.x0_m;
    const double wy = wall.y1_m - wall.y0_m;
    const double cross = dx * wy - dy * wx;
    if (std::abs(cross) < 1e-12) { continue; }
    const double along_ray = ((wall.x0_m - x_m) * wy - (wall.y0_m - y_m) * wx) / cross;
    const double along_wall = ((wall.x0_m - x_m) * dy - (wall.y0_m - y_m) * dx) / cross;
    if (along_ray > 0.0 && along_wall >= 0.0 && along_wall <= 1.0) {
      nearest = std::min(nearest, along_ray);
    }
  }
  return nearest < 29.0 ? nearest : 0.0;
}

/// Points of an instantaneous scan of `beams` over the full circle, in base (lidar in the middle of
/// base).
struct Scan {
  std::vector<float> x_m;
  std::vector<float> y_m;
  [[nodiscard]] PointsView view() const { return {x_m, y_m}; }
};

inline Scan scan_at(const std::vector<Wall>& walls, const Pose2d& pose, int beams = 360) {
  Scan scan;
  for (int k = 0; k < beams; ++k) {
    const double bearing = -3.14159 + 6.28318 * k / beams;
    const double range = cast(walls, pose.x_m, pose.y_m, pose.theta_rad + bearing);
    if (range <= 0.0) { continue; }
    scan.x_m.push_back(static_cast<float>(range * std::cos(bearing)));
    scan.y_m.push_back(static_cast<float>(range * std::sin(bearing)));
  }
  return scan;
}

}  // namespace picolo::test
