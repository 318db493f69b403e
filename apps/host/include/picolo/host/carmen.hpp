// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Recorded drives: CARMEN text (FLASER, ROBOTLASER1, ODOM) and the SWEEP lines of lidars that
/// stamp every beam.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "picolo/host/diagnostics.hpp"
#include "picolo/host/line_reader.hpp"

namespace picolo::host {

/// One scan taken as one instant. Beams counter-clockwise, as logged: what is a measurement and
/// what is a "no return" value is for the reader of the scan to judge.
struct LogScan {
  std::size_t line = 0;
  double stamp_s = 0.0;  ///< as logged
  std::vector<float> ranges_m;
  std::vector<float> bearings_rad;
  std::optional<double> max_range_m;  ///< where the record states it
  Pose2d odom_T_base{};
  Pose2d base_T_lidar{};
  bool has_odometry = false;
};

struct LogOdometry {
  std::size_t line = 0;
  double stamp_s = 0.0;
  Pose2d odom_T_base{};
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// Beam k was measured at stamp_s + k * time_increment_s.
struct LogSweep {
  std::size_t line = 0;
  double stamp_s = 0.0;
  double time_increment_s = 0.0;
  double received_s = 0.0;
  std::vector<float> ranges_m;
  std::vector<float> bearings_rad;
};

struct CarmenLog {
  std::string name;
  std::vector<LogScan> scans;  ///< in file order
  std::vector<LogOdometry> odometry;
  std::vector<LogSweep> sweeps;
  std::string damage;  ///< see LineReader; empty when the file is whole
};

/// Reads to the end. A bad line is skipped with a warning, an unknown keyword silently.
/// FLASER poses are those of the laser, taken as base; bearings as CARMEN's: 180 or 360 beams stand
/// at -90 deg + k * 180/n, any other number n at -90 deg + k * 180/(n-1).
/// Throws UserError (input) when the file cannot be opened.
[[nodiscard]] CarmenLog read_carmen(LineReader& reader, Diagnostics& diagnostics);

/// True when every scan stands at the same odometry pose: loggers write zeros when there are no
/// wheels.
[[nodiscard]] bool odometry_never_moves(const CarmenLog& log);

/// True when every stamp is later than the one before, in whole microseconds as the library sees
/// them.
[[nodiscard]] bool stamps_increase(const CarmenLog& log);

}  // namespace picolo::host
