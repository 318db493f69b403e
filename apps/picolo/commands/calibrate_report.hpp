// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Results of the calibrate commands as JSON, as text, and as pictures of residuals and paths.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "picolo/calibration/joint_batch.hpp"
#include "picolo/calibration/parameter.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/trajectory.hpp"

namespace picolo::tool {

/// {"value": v, "std": s}
[[nodiscard]] host::Json to_json(const Estimate& estimate);
/// null, or "parameter: reason".
[[nodiscard]] host::Json to_json(const Refusal& refusal);
/// Rows of a square matrix stored row-major.
[[nodiscard]] host::Json matrix_json(std::span<const double> elements);
/// axle, l_diam, r_diam, l_x, l_y, l_theta and the rest of what was found.
[[nodiscard]] host::Json joint_json(const JointReport& report);

/// A residual before and after: points in metres, or in what `note` says.
struct Residuals {
  std::vector<Point2<double>> before_m;
  std::vector<Point2<double>> after_m;
  std::string title = "residuals of the displacement between two scans";
  std::string note = "displacements; metres, predicted against measured";
  std::string reference = "lidar";  ///< whose path is yellow
  std::string path_note;            ///< of the path's picture
};

/// residuals and path pictures: odometry green, lidar yellow, corrected red.
void draw_calibration(const std::filesystem::path& folder, const std::string& title,
                      const Residuals& residuals, const host::Trajectory& odometry,
                      const host::Trajectory& lidar, const host::Trajectory& corrected);

/// Prints the JSON line, or the text of each entry; writes calibration.json to the folder.
void print_calibration(const host::Json& json, bool as_json, const std::filesystem::path& folder);

}  // namespace picolo::tool
