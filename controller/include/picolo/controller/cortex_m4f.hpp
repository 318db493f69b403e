// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Bounds of work with which profile `room` keeps to frames of 5 ms on a Cortex-M4F at 168 MHz; see
/// docs/targets.md for what they are made of.
#pragma once

#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/onboard_calibration.hpp"

namespace picolo::inline v0 {

inline constexpr WorkBounds kCortexM4FWork{.max_can_frames = 8,
                                           .max_serial_bytes = 192,
                                           .max_returns = 256,
                                           .max_point_iterations = 900,
                                           .max_rays = 112,
                                           .max_search_slices = 1,
                                           .one_stage_a_frame = true};

/// At 168 million instructions a second; undistortion, match and map update share theirs.
inline constexpr TaskBudgets kCortexM4FBudgets{.can = Duration{230},
                                               .serial = Duration{230},
                                               .odometry = Duration{563},
                                               .undistort = Duration{2940},
                                               .match = Duration{2940},
                                               .map = Duration{2940},
                                               .background = Duration{862},
                                               .report = Duration{170}};

[[nodiscard]] constexpr ControllerConfig for_cortex_m4f(ControllerConfig config) {
  config.work = kCortexM4FWork;
  config.budgets = kCortexM4FBudgets;
  config.localiser.max_repair_tiles = 6;
  config.localiser.search.lookups_per_step = 4096;
  config.localiser.relocalise.nodes_per_step = 16;
  return config;
}

[[nodiscard]] constexpr OnboardCalibrationConfig for_cortex_m4f(OnboardCalibrationConfig config) {
  config.scans.max_looks = 800;
  config.routine.lags_per_step = 8;
  return config;
}

}  // namespace picolo::inline v0
