// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/surface.hpp"

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"

namespace picolo::inline v0 {
namespace {

float dot(Point2f a, Point2f b) {
  return a.x_m * b.x_m + a.y_m * b.y_m;
}

float cross(Point2f a, Point2f b) {
  return a.x_m * b.y_m - a.y_m * b.x_m;
}

std::int8_t to_step(float x) {
  return static_cast<std::int8_t>(round_to_i32(x, -127, 127));
}

}  // namespace

void surface_directions(const PointsView& points, const SurfaceConfig& config,
                        std::span<std::int8_t> along_x, std::span<std::int8_t> along_y) {
  const std::size_t count = std::min({points.size(), along_x.size(), along_y.size()});
  const auto most = static_cast<std::size_t>(config.max_neighbours);
  const float reach_squared = config.reach_m * config.reach_m;
  const float cosine_squared = config.min_cosine * config.min_cosine;
  const float offset_squared = config.max_offset_m * config.max_offset_m;
  const auto from_to = [&points](std::size_t a, std::size_t b) {
    return Point2f{points.x_m[b] - points.x_m[a], points.y_m[b] - points.y_m[a]};
  };
  for (std::size_t k = 0; k < count; ++k) {
    along_x[k] = 0;
    along_y[k] = 0;
    const std::size_t first = k - std::min(k, most);
    const std::size_t last = std::min(count - 1, k + most);
    if (first == k || last == k) { continue; }
    std::size_t before = k - 1;
    while (before > first && dot(from_to(before, k), from_to(before, k)) < reach_squared) {
      --before;
    }
    std::size_t after = k + 1;
    while (after < last && dot(from_to(k, after), from_to(k, after)) < reach_squared) { ++after; }
    const Point2f to_here = from_to(before, k);
    const Point2f from_here = from_to(k, after);
    const Point2f chord = from_to(before, after);
    const float along = dot(to_here, from_here);
    const float chord_squared = dot(chord, chord);
    const float off = cross(chord, to_here);
    const bool straight =
        along > 0.0F &&
        along * along >= cosine_squared * (dot(to_here, to_here) * dot(from_here, from_here)) &&
        off * off <= offset_squared * chord_squared;
    if (!straight) { continue; }
    const float scale = 127.0F / square_root(chord_squared);
    along_x[k] = to_step(scale * chord.x_m);
    along_y[k] = to_step(scale * chord.y_m);
  }
}

}  // namespace picolo::inline v0
