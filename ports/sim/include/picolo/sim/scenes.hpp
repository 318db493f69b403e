// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Worlds to drive in, each with a route that keeps clear of the walls.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sim/world.hpp"

namespace picolo::inline v0::sim {

inline constexpr std::size_t kMaxRoutePoints = 64;
using Route = FixedVector<Point2d, kMaxRoutePoints>;

struct Scene {
  World world{};
  Route route{};           ///< way points in the world frame, in order
  bool closed = true;      ///< after the last point comes the first again, for ever
  Pose2d world_T_start{};  ///< where the base stands at the beginning
};

enum class SceneName : std::uint8_t {
  office,  ///< 20 x 15 m: seven rooms on both sides of a corridor, furniture; a loop of about 57 m
  room,    ///< 8 x 6 m, one room with a niche and two boxes
  corridor,  ///< 30 x 2 m, almost featureless: its length is seen only near the ends and at two
             ///< door frames
  hall,      ///< 30 x 20 m with 15 pillars: most of the walls are out of a small lidar's reach
};

[[nodiscard]] Scene make_scene(SceneName name);

}  // namespace picolo::inline v0::sim
