// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/world.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0::sim {
namespace {

double cross(const Point2d& a, const Point2d& b) {
  return a.x_m * b.y_m - a.y_m * b.x_m;
}

double dot(const Point2d& a, const Point2d& b) {
  return a.x_m * b.x_m + a.y_m * b.y_m;
}

Point2d difference(const Point2d& a, const Point2d& b) {
  return {.x_m = a.x_m - b.x_m, .y_m = a.y_m - b.y_m};
}

/// Walls that share an end must not let a ray through between them.
constexpr double kSeam = 1e-9;

}  // namespace

bool World::add(const Wall& wall) {
  return walls_.push_back(wall);
}

bool World::add_box(const Point2d& low, const Point2d& high) {
  if (walls_.size() + 4 > kCapacity) { return false; }
  const Point2d right_low{.x_m = high.x_m, .y_m = low.y_m};
  const Point2d left_high{.x_m = low.x_m, .y_m = high.y_m};
  return add({low, right_low}) && add({right_low, high}) && add({high, left_high}) &&
         add({left_high, low});
}

double World::cast(const Point2d& origin, double bearing_rad, double max_range_m) const {
  const SinCos<double> direction = sin_cos(bearing_rad);
  const Point2d ray{.x_m = direction.cosine, .y_m = direction.sine};
  double nearest_m = 0.0;
  for (const Wall& wall : walls_) {
    const Point2d along = difference(wall.to, wall.from);
    const double denominator = cross(ray, along);
    if (denominator == 0.0) { continue; }
    const Point2d offset = difference(wall.from, origin);
    const double share = cross(offset, ray) / denominator;
    if (share < -kSeam || share > 1.0 + kSeam) { continue; }
    const double range_m = cross(offset, along) / denominator;
    if (range_m <= 0.0 || range_m > max_range_m) { continue; }
    if (nearest_m == 0.0 || range_m < nearest_m) { nearest_m = range_m; }
  }
  return nearest_m;
}

double World::clearance(const Point2d& point) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls_) {
    const Point2d along = difference(wall.to, wall.from);
    const Point2d offset = difference(point, wall.from);
    const double length2_m2 = dot(along, along);
    const double share =
        length2_m2 > 0.0 ? std::clamp(dot(offset, along) / length2_m2, 0.0, 1.0) : 0.0;
    const double distance_m =
        hypotenuse(offset.x_m - share * along.x_m, offset.y_m - share * along.y_m);
    nearest_m = std::min(nearest_m, distance_m);
  }
  return nearest_m;
}

}  // namespace picolo::inline v0::sim
