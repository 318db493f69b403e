// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle around a board that runs by its own clock: it follows the board's pulses
/// and talks through its UARTs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "picolo/controller/command_gate.hpp"
#include "picolo/core/time.hpp"
#include "picolo/linux/file_byte_store.hpp"
#include "picolo/simulated/trajectory_hash.hpp"
#include "platforms.hpp"

namespace picolo::target {

struct Ask {
  Duration at;  ///< since the start; in the order of the list
  Command command;
};

struct FreeDrivePlan {
  sim::SimulationConfig world = hashed_drive(sim::SceneName::office);
  int seconds = 5;
  int wrap_ms = 2000;         ///< after so long the clock's hardware counter wraps
  Duration judged_from = 1s;  ///< errors count from then on
  std::vector<Ask> asks{};
  Duration erase_time{0};              ///< of a sector of the flash
  bool erase_waits = false;            ///< and the processor stands still meanwhile
  std::filesystem::path flash_file{};  ///< for the flash after a reset at the end; empty: no reset
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
  CalibrationPhase calibration_phase = CalibrationPhase::idle;  ///< last told
};

/// Boards on which `free_running` was built.
[[nodiscard]] std::vector<Platform> boards_with_devices();
[[nodiscard]] FreeDrive drive_freely(const Platform& platform, const FreeDrivePlan& plan);

[[nodiscard]] std::int64_t overruns_in(const Figures& figures);  ///< of all tasks
[[nodiscard]] std::int64_t bytes_lost(const Figures& figures);   ///< of all UARTs
/// How to open a file of `FreeDrivePlan::flash_file`.
[[nodiscard]] FileByteStoreConfig flash_in(const std::filesystem::path& file);
/// The map in the board's flash after the reset: read by the host, it is the one that the board
/// itself loads, and the next drive in the same world is localised in it.
void expect_map_kept(const FreeDrivePlan& plan, const FreeDrive& drive);

}  // namespace picolo::target
