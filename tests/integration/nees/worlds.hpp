// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The worlds of the NEES table, each with a route of more than 10 m, and a world's true map.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/localisation/localiser.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/sim/scenes.hpp"

namespace picolo::test {

enum class NeesWorld : std::uint8_t { room, office, corridor, single_wall, circle, open_space };

inline void set_route(sim::Scene& scene, std::initializer_list<sim::Point2d> points, bool closed) {
  for (const sim::Point2d& point : points) { (void)scene.route.push_back(point); }
  scene.closed = closed;
  const sim::Point2d from = scene.route[0];
  const sim::Point2d to = scene.route[1];
  scene.world_T_start = {from.x_m, from.y_m, std::atan2(to.y_m - from.y_m, to.x_m - from.x_m)};
}

inline sim::Scene nees_scene(NeesWorld world) {
  sim::Scene scene;
  constexpr double kFar_m = 300.0;
  switch (world) {
    case NeesWorld::room: return sim::make_scene(sim::SceneName::room);
    case NeesWorld::office: return sim::make_scene(sim::SceneName::office);
    case NeesWorld::corridor:
      (void)scene.world.add({{-kFar_m, -1.0}, {kFar_m, -1.0}});
      (void)scene.world.add({{-kFar_m, 1.0}, {kFar_m, 1.0}});
      set_route(scene, {{0.0, 0.0}, {4.0, 0.3}, {8.0, -0.3}, {14.0, 0.0}}, false);
      break;
    case NeesWorld::single_wall:
      (void)scene.world.add({{-kFar_m, 1.5}, {kFar_m, 1.5}});
      set_route(scene, {{0.0, 0.0}, {4.0, 0.3}, {8.0, -0.3}, {14.0, 0.0}}, false);
      break;
    case NeesWorld::circle: {
      constexpr int kSides = 180;
      const auto at = [](int side, double radius_m) {
        const double angle_rad = 2.0 * std::numbers::pi * side / kSides;
        return sim::Point2d{radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)};
      };
      for (int i = 0; i < kSides; ++i) { (void)scene.world.add({at(i, 3.0), at(i + 1, 3.0)}); }
      for (int i = 0; i < kSides; i += 10) { (void)scene.route.push_back(at(i, 1.5)); }
      scene.world_T_start = {1.5, 0.0, std::numbers::pi / 2.0};
      break;
    }
    case NeesWorld::open_space:
      set_route(scene, {{0.0, 0.0}, {4.0, 0.3}, {8.0, -0.3}, {14.0, 0.0}}, false);
      break;
  }
  return scene;
}

/// The middle of what is seen on the first 10 m, in the world frame.
inline Point2<double> nees_centre(NeesWorld world) {
  switch (world) {
    case NeesWorld::room: return {3.5, 3.0};
    case NeesWorld::office: return {5.0, 10.0};
    case NeesWorld::circle: return {0.0, 0.0};
    case NeesWorld::corridor:
    case NeesWorld::single_wall:
    case NeesWorld::open_space: break;
  }
  return {5.0, 0.0};
}

/// Cells that a wall touches are occupied, all others free.
template <Profile P>
std::unique_ptr<RollingMap<P::kWidth, P::kHeight>> true_map(const sim::World& world,
                                                            const Pose2d& map_T_world,
                                                            const Point2<double>& centre) {
  auto map = std::make_unique<RollingMap<P::kWidth, P::kHeight>>(fine_map_config<P>({}));
  RollingMapCore& core = map->core();
  const Point2<double> at = transform(map_T_world, centre);
  core.reset(at.x_m, at.y_m);
  const GridWindow window = core.window();
  const double cell_m = static_cast<double>(P::kCell_m);
  std::vector<std::int8_t> cells(static_cast<std::size_t>(P::kWidth) * P::kHeight,
                                 core.config().low);
  for (const sim::Wall& wall : world.walls()) {
    const double length_m = std::hypot(wall.to.x_m - wall.from.x_m, wall.to.y_m - wall.from.y_m);
    const int steps = 1 + static_cast<int>(length_m / (0.1 * cell_m));
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const Point2<double> p = transform(
          map_T_world, Point2<double>{wall.from.x_m + share * (wall.to.x_m - wall.from.x_m),
                                      wall.from.y_m + share * (wall.to.y_m - wall.from.y_m)});
      const double column = std::floor(p.x_m / cell_m) - window.origin_x_cells;
      const double row = std::floor(p.y_m / cell_m) - window.origin_y_cells;
      if (column < 0 || row < 0 || column >= P::kWidth || row >= P::kHeight) { continue; }
      cells[static_cast<std::size_t>(row) * P::kWidth + static_cast<std::size_t>(column)] =
          core.config().high;
    }
  }
  for (int row = 0; row < P::kHeight; ++row) {
    core.restore(0, row,
                 {cells.data() + static_cast<std::ptrdiff_t>(row) * P::kWidth,
                  static_cast<std::size_t>(P::kWidth)});
  }
  return map;
}

}  // namespace picolo::test
