// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// calibration.json as the calibrate commands write it, applied to a log's odometry.
#pragma once

#include <optional>
#include <string>

#include "picolo/calibration/wheel_model.hpp"
#include "picolo/geometry/matrix3.hpp"
#include "picolo/host/carmen.hpp"

namespace picolo::tool {

/// What a file holds: a 3x3 matrix or wheels, and where the lidar is when that was found too.
struct CalibrationFile {
  std::string name;
  std::optional<Matrix3d> correction;
  std::optional<DriveParameters> wheels;
  std::optional<Pose2d> base_T_lidar;
};

/// Throws UserError (input): unreadable, refused, or none of the known keys.
[[nodiscard]] CalibrationFile read_calibration(const std::string& path);

/// Replaces the odometry of the log: its own steps times the matrix, or its TICKS (read from
/// `path`) through the wheels. Throws UserError (input) when wheels are given and the log has no
/// TICKS.
void apply_to_odometry(const CalibrationFile& calibration, const std::string& path,
                       double ticks_per_turn, host::CarmenLog& log);

}  // namespace picolo::tool
