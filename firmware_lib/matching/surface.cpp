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
  const float sparse_squared = config.sparse_m * config.sparse_m;
  const float cosine_squared = config.min_cosine * config.min_cosine;
  const float offset_squared = config.max_offset_m * config.max_offset_m;
  const auto from_to = [&points](std::size_t a, std::size_t b) {
    return Point2f{points.x_m[b] - points.x_m[a], points.y_m[b] - points.y_m[a]};
  };
  const auto far = [&](std::size_t a, std::size_t b, float squared) {
    return dot(from_to(a, b), from_to(a, b)) >= squared;
  };
  const auto before = [&](std::size_t k) {
    const std::size_t first = k - std::min(k, most);
    std::size_t at = k - std::min<std::size_t>(k, 1);
    while (at > first && !far(at, k, reach_squared)) { --at; }
    return at;
  };
  const auto after = [&](std::size_t k) {
    const std::size_t last = std::min(count - 1, k + most);
    std::size_t at = std::min(last, k + 1);
    while (at < last && !far(k, at, reach_squared)) { ++at; }
    return at;
  };
  const auto straight = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (a == b || b == c) { return false; }
    const Point2f to_here = from_to(a, b);
    const Point2f from_here = from_to(b, c);
    const Point2f chord = from_to(a, c);
    const float along = dot(to_here, from_here);
    const float off = cross(chord, to_here);
    return along > 0.0F &&
           along * along >= cosine_squared * (dot(to_here, to_here) * dot(from_here, from_here)) &&
           off * off <= offset_squared * dot(chord, chord);
  };
  for (std::size_t k = 0; k < count; ++k) {
    along_x[k] = 0;
    along_y[k] = 0;
    std::size_t from = before(k);
    std::size_t to = after(k);
    if (!straight(from, k, to)) {
      if (k + 1 < count && far(k, k + 1, sparse_squared) && straight(k, k + 1, after(k + 1))) {
        from = k;
        to = after(k + 1);
      } else if (k > 0 && far(k - 1, k, sparse_squared) && straight(before(k - 1), k - 1, k)) {
        from = before(k - 1);
        to = k;
      } else {
        continue;
      }
    }
    const Point2f chord = from_to(from, to);
    const float scale = 127.0F / square_root(dot(chord, chord));
    along_x[k] = to_step(scale * chord.x_m);
    along_y[k] = to_step(scale * chord.y_m);
  }
}

}  // namespace picolo::inline v0
