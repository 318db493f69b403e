// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/ray_cast.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

/// One axis of the walk: lengths along the beam, in cells.
struct Axis {
  int cell = 0;
  int step = 0;
  float next = std::numeric_limits<float>::infinity();     // length at the next border
  float between = std::numeric_limits<float>::infinity();  // from border to border
};

Axis make_axis(float start_cells, float direction, int size) {
  Axis axis;
  axis.cell = floor_to_i32(start_cells, -1, size);
  const float inside = start_cells - static_cast<float>(axis.cell);
  if (direction > 0.0F) {
    axis.step = 1;
    axis.between = 1.0F / direction;
    axis.next = (1.0F - inside) / direction;
  } else if (direction < 0.0F) {
    axis.step = -1;
    axis.between = -1.0F / direction;
    axis.next = -inside / direction;
  }
  return axis;
}

}  // namespace

ExpectedRange cast_ray(const RollingMapCore& map, const Pose2f& window_T_lidar, float bearing_rad,
                       float max_m) {
  const GridWindow& window = map.window();
  const float cells_per_m = 1.0F / window.cell_m;
  const SinCos<float> direction = sin_cos(window_T_lidar.theta_rad + bearing_rad);
  Axis x = make_axis(window_T_lidar.x_m * cells_per_m, direction.cosine, window.width);
  Axis y = make_axis(window_T_lidar.y_m * cells_per_m, direction.sine, window.height);
  const float max_cells = max_m * cells_per_m;
  ExpectedRange result;
  float entered = 0.0F;
  const int limit = window.width + window.height;
  for (int i = 0; i < limit && entered <= max_cells; ++i) {
    if (x.cell < 0 || y.cell < 0 || x.cell >= window.width || y.cell >= window.height) { break; }
    const float leaves = std::min(x.next, y.next);
    const std::int8_t cell =
        map.occupancy()[static_cast<std::size_t>(y.cell) * static_cast<std::size_t>(window.width) +
                        static_cast<std::size_t>(x.cell)];
    if (cell >= map.config().occupied_from) {
      result.range_m = 0.5F * (entered + leaves) * window.cell_m;
      result.met_obstacle = result.range_m <= max_m;
      break;
    }
    result.saw_unknown = result.saw_unknown || cell == 0;
    entered = leaves;
    Axis& crossed = x.next < y.next ? x : y;
    crossed.cell += crossed.step;
    crossed.next += crossed.between;
  }
  return result;
}

}  // namespace picolo::inline v0
