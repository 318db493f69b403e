// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/grid_window.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

double corner_m(std::int32_t origin_cells, float cell_m) {
  return static_cast<double>(origin_cells) * static_cast<double>(cell_m);
}

}  // namespace

Pose2f to_window(const GridWindow& window, const Pose2d& map_T_base) {
  return to_f32({map_T_base.x_m - corner_m(window.origin_x_cells, window.cell_m),
                 map_T_base.y_m - corner_m(window.origin_y_cells, window.cell_m),
                 map_T_base.theta_rad});
}

Pose2d to_map(const GridWindow& window, const Pose2f& window_T_base) {
  const Pose2d pose = to_f64(window_T_base);
  return {pose.x_m + corner_m(window.origin_x_cells, window.cell_m),
          pose.y_m + corner_m(window.origin_y_cells, window.cell_m), pose.theta_rad};
}

}  // namespace picolo::inline v0
