// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The range that a map predicts for a beam.
#pragma once

#include "picolo/map/rolling_map.hpp"

namespace picolo::inline v0 {

struct ExpectedRange {
  float range_m = 0.0F;       ///< to the middle of the beam's way through the first occupied cell
  bool met_obstacle = false;  ///< false: nothing within max_m, or the beam left the window
  bool saw_unknown = false;   ///< it crossed cells that were never observed before that
};

/// Walks every cell that the beam crosses (Amanatides and Woo 1987). Window coordinates; a beam
/// that begins outside of the window meets nothing. Cost: about 15 instructions a cell, at most
/// width + height cells. Context: cycle only.
[[nodiscard]] ExpectedRange cast_ray(const RollingMapCore& map, const Pose2f& window_T_lidar,
                                     float bearing_rad, float max_m);

}  // namespace picolo::inline v0
