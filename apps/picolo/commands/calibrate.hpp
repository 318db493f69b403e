// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The calibrate commands, one file each; calibrate.cpp adds them to the command line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "commands.hpp"
#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/wheel_model.hpp"

namespace picolo::tool {

struct CalibrateOptions {
  CommonOptions common;
  std::string file;
  std::string odometry;
  std::string scan_match;
  std::uint64_t limit = 0;
  int outlier_rounds = -1;  ///< -1: what suits the command
  double quantile = 0.99;
  double ticks_per_turn = 0.0;
  double max_offset_s = 0.5;
  bool single_pass = false;
  double fit_share = 1.0;
  double nominal_radius_m = 0.1;
  double nominal_track_m = 0.5;
  double collect_share = 0.85;  ///< of a log; the rest is fresh data to verify by
};

ExitCode calibrate_wheels_command(const CalibrateOptions& options);
ExitCode calibrate_joint_command(const CalibrateOptions& options);
ExitCode calibrate_linear_command(const CalibrateOptions& options);
ExitCode calibrate_extrinsic_command(const CalibrateOptions& options);
ExitCode calibrate_time_offset_command(const CalibrateOptions& options);
ExitCode calibrate_routine_command(const CalibrateOptions& options);
ExitCode calibrate_track_command(const CalibrateOptions& options);
ExitCode calibrate_memory_command(const CalibrateOptions& options);

/// Pictures of wheels with equal radii, of the lidar, and of the calibrated wheels.
void draw_joint(const std::vector<MotionSample>& samples, const DriveParameters& drive,
                const std::string& title, const std::string& folder);

/// refused when there is a refusal, else what the input's end asks for.
ExitCode end_of_calibration(const Refusal& refusal, const std::string& name,
                            const std::string& damage);

}  // namespace picolo::tool
