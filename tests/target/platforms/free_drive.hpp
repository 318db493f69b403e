// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle around a board that runs by its own clock: it follows the board's pulses
/// and talks through its UARTs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "picolo/controller/command_gate.hpp"
#include "picolo/core/time.hpp"
#include "picolo/sim/scenes.hpp"
#include "platforms.hpp"

namespace picolo::target {

struct FreeDrivePlan {
  sim::SceneName scene = sim::SceneName::office;
  int seconds = 5;
  int wrap_ms = 2000;         ///< after so long the clock's hardware counter wraps
  Duration judged_from = 1s;  ///< errors count from then on
  std::vector<Command> asks;  ///< one a second, from the second second on
};

struct FreeDrive {
  std::string trouble;                 ///< empty: the board ran to its end
  Figures figures;                     ///< that the image told at its end
  std::uint32_t poses = 0;             ///< with their time, on the bus
  std::uint32_t damaged_lines = 0;     ///< of the board's
  double worst_error_m = 0.0;          ///< of poses to the truth
  double driven_m = 0.0;               ///< greatest distance from the start
  std::vector<CommandResult> answers;  ///< to `asks`, in their order
  std::uint32_t calibration_frames = 0;
};

[[nodiscard]] FreeDrive drive_freely(const Platform& platform, const FreeDrivePlan& plan);

}  // namespace picolo::target
