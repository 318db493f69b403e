// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the calibrate commands read: rows of numbers, and drives with raw counters, scans or a
/// gyro.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "picolo/calibration/samples.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/calibration/track_batch.hpp"
#include "picolo/host/diagnostics.hpp"

namespace picolo::tool {

/// Rows of at least `columns` numbers each; '#' starts a comment line. Throws UserError (input)
/// when none is found.
struct NumberFile {
  std::string name;
  std::vector<std::vector<double>> rows;
  std::string damage;
};
[[nodiscard]] NumberFile read_numbers(const std::string& path, std::size_t columns,
                                      host::Diagnostics& diagnostics);

struct PointScan {
  double stamp_s = 0.0;
  std::vector<float> x_m;  ///< in the lidar's frame
  std::vector<float> y_m;
  Pose2d odom_T_base{};
  bool has_odometry = false;
};

struct GyroRow {
  double stamp_s = 0.0;
  double rate_radps = 0.0;
};

/// A recorded drive. Wheel angles are counts * scale.
struct DriveFile {
  std::string name;
  std::vector<WheelAngles> wheels;
  std::vector<PointScan> scans;
  std::vector<GyroRow> gyro;
  std::vector<TrackPosition> track;
  std::vector<std::vector<double>>
      pairs;  ///< rows of six numbers, when the file holds nothing else
  std::string damage;
};

/// TICKS t left right, ENC t FR FL RR RL, IMU t wx wy wz ..., SCANMM t n ranges, REFMM t x y,
/// FLASER, ROBOTLASER1, or plain rows of six numbers. `ticks_per_turn` 0: angles are counts. Throws
/// UserError (input) when nothing of it is found.
[[nodiscard]] DriveFile read_drive(const std::string& path, double ticks_per_turn,
                                   host::Diagnostics& diagnostics);

/// Motion of the lidar between two scans.
struct ScanStep {
  std::size_t scan = 0;  ///< index of the later scan
  Pose2d lidar_motion{};
  bool converged = false;
};

/// Point-to-line ICP from scan to scan; starts from odometry where the scans carry it, else from
/// the step before.
[[nodiscard]] std::vector<ScanStep> match_scans(const DriveFile& drive, const Pose2d& base_T_lidar);

/// The wheels at an instant, linear between counters; clamped at the ends.
[[nodiscard]] WheelAngles wheels_at(const std::vector<WheelAngles>& wheels, double stamp_s);

}  // namespace picolo::tool
