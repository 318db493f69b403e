// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A plane with walls, and the ray that a lidar casts in it.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0::sim {

using Point2d = Point2<double>;

/// A straight wall without thickness, in the world frame.
struct Wall {
  Point2d from{};
  Point2d to{};
};

/// Walls in a fixed capacity; nothing moves. Everything is double: the truth must be finer than
/// what is judged by it.
class World {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// False when full; nothing is changed then.
  [[nodiscard]] bool add(const Wall& wall);
  /// Four walls around a rectangle; false when they do not all fit.
  [[nodiscard]] bool add_box(const Point2d& low, const Point2d& high);

  /// Distance along the ray from `origin` to the first wall within `max_range_m`, 0 when there is
  /// none. A ray along a wall's own line does not see it. Cost: O(walls).
  [[nodiscard]] double cast(const Point2d& origin, double bearing_rad, double max_range_m) const;
  /// Distance from `point` to the nearest wall; infinity without walls. Cost: O(walls).
  [[nodiscard]] double clearance(const Point2d& point) const;
  [[nodiscard]] std::span<const Wall> walls() const { return walls_.view(); }

 private:
  FixedVector<Wall, kCapacity> walls_{};
};

}  // namespace picolo::inline v0::sim
