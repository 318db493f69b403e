// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/scenes.hpp"

#include <array>
#include <span>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0::sim {
namespace {

/// x0 y0 x1 y1 of a wall or of a box, metres.
struct Line {
  double x0, y0, x1, y1;
};

void add_walls(World& world, std::span<const Line> lines) {
  for (const Line& line : lines) {
    static_cast<void>(world.add({{line.x0, line.y0}, {line.x1, line.y1}}));
  }
}

void add_boxes(World& world, std::span<const Line> boxes) {
  for (const Line& box : boxes) {
    static_cast<void>(world.add_box({box.x0, box.y0}, {box.x1, box.y1}));
  }
}

/// Nobody parks a vehicle exactly parallel to the walls. Exactly parallel, with walls at multiples
/// of a map's cells, is the one case in which all walls are off in the same way: by up to half a
/// cell.
constexpr double kParkedAskew_rad = 0.1;

/// The vehicle starts on the first point and looks beside the second.
void set_route(Scene& scene, std::span<const Point2d> points, bool closed) {
  for (const Point2d& point : points) { static_cast<void>(scene.route.push_back(point)); }
  scene.closed = closed;
  const double heading_rad =
      arc_tangent2(points[1].y_m - points[0].y_m, points[1].x_m - points[0].x_m);
  scene.world_T_start = {
      .x_m = points[0].x_m, .y_m = points[0].y_m, .theta_rad = heading_rad + kParkedAskew_rad};
}

Scene make_office() {
  Scene scene;
  constexpr std::array kWalls = {
      Line{0, 0, 20, 0}, Line{20, 0, 20, 15}, Line{20, 15, 0, 15}, Line{0, 15, 0, 0},
      // north side of the corridor, with four doors
      Line{0, 8.5, 2, 8.5}, Line{3.2, 8.5, 7, 8.5}, Line{8.2, 8.5, 12, 8.5},
      Line{13.2, 8.5, 17, 8.5}, Line{18.2, 8.5, 20, 8.5},
      // south side, three doors
      Line{0, 6.5, 3, 6.5}, Line{4.2, 6.5, 9, 6.5}, Line{10.2, 6.5, 16, 6.5},
      Line{17.2, 6.5, 20, 6.5},
      // between the rooms in the north; the first and the third have a door
      Line{5, 8.5, 5, 12}, Line{5, 13.2, 5, 15}, Line{10, 8.5, 10, 15}, Line{15, 8.5, 15, 11.5},
      Line{15, 12.7, 15, 15},
      // between the rooms in the south, both with a door
      Line{6, 0, 6, 2}, Line{6, 3.2, 6, 6.5}, Line{13, 0, 13, 3}, Line{13, 4.2, 13, 6.5},
      // door leaves, open into the rooms
      Line{2, 8.5, 1.7, 9.6}, Line{12, 8.5, 11.8, 9.6}, Line{17.2, 6.5, 17.7, 5.5}};
  constexpr std::array kFurniture = {
      Line{0.3, 13.2, 1.5, 14.6}, Line{3.9, 8.7, 4.8, 10.4},    Line{8.6, 13.3, 9.8, 14.7},
      Line{5.2, 9, 5.9, 10},      Line{10.2, 13.4, 12, 14.2},   Line{13.6, 8.8, 14.7, 9.9},
      Line{18.6, 12, 19.6, 14.4}, Line{15.3, 13.9, 16.6, 14.8}, Line{0.2, 0.3, 2, 1.4},
      Line{0.2, 4.6, 1.1, 6},     Line{6.9, 0.2, 9.2, 1.1},     Line{11.4, 5, 12.4, 6.1},
      Line{18.2, 0.4, 19.6, 2.6}, Line{13.8, 0.3, 15, 1.2},     Line{0.05, 7.1, 0.5, 7.9}};
  constexpr std::array kRoute = {
      Point2d{3.6, 7.5},   Point2d{2.6, 7.5},   Point2d{2.6, 12.6}, Point2d{6.6, 12.6},
      Point2d{7.6, 11.6},  Point2d{7.6, 7.5},   Point2d{12.6, 7.5}, Point2d{12.6, 12.1},
      Point2d{16.6, 12.1}, Point2d{17.6, 11.1}, Point2d{17.6, 7.5}, Point2d{16.6, 7.5},
      Point2d{16.6, 3.6},  Point2d{10.6, 3.6},  Point2d{8.2, 2.6},  Point2d{3.6, 2.6}};
  add_walls(scene.world, kWalls);
  add_boxes(scene.world, kFurniture);
  set_route(scene, kRoute, true);
  return scene;
}

Scene make_room() {
  Scene scene;
  constexpr std::array kWalls = {Line{0, 0, 8, 0},        Line{8, 0, 8, 4},
                                 Line{8, 4, 7, 4},        Line{7, 4, 7, 6},
                                 Line{7, 6, 0, 6},        Line{0, 6, 0, 3.4},
                                 Line{0, 3.4, -0.8, 3.4}, Line{-0.8, 3.4, -0.8, 2.2},
                                 Line{-0.8, 2.2, 0, 2.2}, Line{0, 2.2, 0, 0}};
  constexpr std::array kBoxes = {Line{3.2, 2.6, 4.4, 3.4}, Line{6.9, 0.2, 7.7, 0.9}};
  constexpr std::array kRoute = {Point2d{1.5, 1.2}, Point2d{5.8, 1.2}, Point2d{6.2, 3.4},
                                 Point2d{5.6, 4.8}, Point2d{1.6, 4.8}, Point2d{1.2, 2.8}};
  add_walls(scene.world, kWalls);
  add_boxes(scene.world, kBoxes);
  set_route(scene, kRoute, true);
  return scene;
}

Scene make_corridor() {
  Scene scene;
  constexpr std::array kWalls = {Line{0, 0, 30, 0}, Line{30, 0, 30, 2}, Line{30, 2, 0, 2},
                                 Line{0, 2, 0, 0}};
  constexpr std::array kFrames = {Line{9, 1.9, 9.1, 2}, Line{20, 0, 20.1, 0.1}};
  constexpr std::array kRoute = {Point2d{1.5, 0.9}, Point2d{28.5, 0.9}, Point2d{28.5, 1.1},
                                 Point2d{1.5, 1.1}};
  add_walls(scene.world, kWalls);
  add_boxes(scene.world, kFrames);
  set_route(scene, kRoute, true);
  return scene;
}

Scene make_hall() {
  Scene scene;
  constexpr std::array kWalls = {Line{0, 0, 30, 0}, Line{30, 0, 30, 20}, Line{30, 20, 0, 20},
                                 Line{0, 20, 0, 0}};
  add_walls(scene.world, kWalls);
  for (int column = 0; column < 5; ++column) {
    for (int row = 0; row < 3; ++row) {
      const double x_m = 5.0 + 5.0 * column;
      const double y_m = 5.0 + 5.0 * row;
      static_cast<void>(scene.world.add_box({x_m - 0.25, y_m - 0.25}, {x_m + 0.25, y_m + 0.25}));
    }
  }
  constexpr std::array kRoute = {Point2d{7.5, 2.5},   Point2d{27.5, 2.5},  Point2d{27.5, 7.5},
                                 Point2d{2.5, 7.5},   Point2d{2.5, 12.5},  Point2d{27.5, 12.5},
                                 Point2d{27.5, 17.5}, Point2d{12.5, 17.5}, Point2d{12.5, 7.5},
                                 Point2d{7.5, 7.5}};
  set_route(scene, kRoute, true);
  return scene;
}

}  // namespace

Scene make_scene(SceneName name) {
  switch (name) {
    case SceneName::office: return make_office();
    case SceneName::room: return make_room();
    case SceneName::corridor: return make_corridor();
    case SceneName::hall: return make_hall();
  }
  return {};
}

}  // namespace picolo::inline v0::sim
