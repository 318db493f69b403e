// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle on this side, the controller in an image on the other, its twin here
/// beside it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drives.hpp"
#include "platforms.hpp"
#include "work_model.hpp"

namespace picolo::target {

/// What the background task of a frame was about.
enum class BackgroundWork : std::uint8_t { none, search, relocalisation, calibration };

struct SweepRun {
  std::uint32_t last_frame = 0;  ///< in which its work ended
  bool searched = false;
  SweepWork work{};  ///< what the twin counted of it
};

struct LockstepRun {
  std::string trouble;  ///< empty: every frame was answered
  std::uint32_t frames = 0;
  std::uint32_t unequal = 0;  ///< frames whose reply differs from the twin's
  std::uint32_t first_unequal = 0;
  std::uint32_t pose_frames = 0;                  ///< CAN frames that the controllers sent
  std::uint32_t matches = 0;                      ///< of the twin
  std::uint32_t replaced = 0;                     ///< sweeps of the twin, by newer ones
  double final_error_m = 0.0;                     ///< of the twin, to the truth
  CalibrationProgress calibration{};              ///< of the twin, at the end
  std::vector<std::vector<std::uint32_t>> ticks;  ///< of each frame, by task; image's own
  std::vector<BackgroundWork> background;         ///< of each frame
  std::vector<SweepRun> sweeps;
  std::uint32_t deepest_stack_bytes = 0;
};

/// `icount`: QEMU counts 64 ns an instruction, so that ticks are instructions. `calibrates`: the
/// image that has the routine.
LockstepRun run_lockstep(const Platform& platform, Drive& drive, bool icount,
                         bool calibrates = false);

}  // namespace picolo::target
