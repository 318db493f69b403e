// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle on this side, the controller in an image on the other, its twin here
/// beside it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "picolo/core/time.hpp"
#include "picolo/sim/scenes.hpp"
#include "platforms.hpp"

namespace picolo::target {

struct LockstepRun {
  std::string trouble;  ///< empty: every frame was answered
  std::uint32_t frames = 0;
  std::uint32_t unequal = 0;  ///< frames whose reply differs from the twin's
  std::uint32_t first_unequal = 0;
  std::uint32_t pose_frames = 0;                  ///< CAN frames that the controllers sent
  std::uint32_t matches = 0;                      ///< of the twin
  double final_error_m = 0.0;                     ///< of the twin, to the truth
  std::vector<std::vector<std::uint32_t>> ticks;  ///< of each frame, by task; image's own
  std::vector<std::uint32_t> sweep_ends;          ///< frames in which a sweep's work ended
  std::vector<bool> searched;                     ///< that sweep needed a search
  std::uint32_t deepest_stack_bytes = 0;
};

/// `icount`: QEMU counts 64 ns an instruction, so that ticks are instructions.
LockstepRun run_lockstep(const Platform& platform, sim::SceneName scene, Duration length,
                         bool icount);

}  // namespace picolo::target
