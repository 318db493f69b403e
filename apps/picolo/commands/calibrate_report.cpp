// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands/calibrate_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "picolo/host/files.hpp"
#include "picolo/host/picture.hpp"

namespace picolo::tool {
namespace {

constexpr host::Colour kOdometryGreen{22, 150, 66};
constexpr host::Colour kLidarYellow{222, 180, 10};
constexpr host::Colour kCorrectedRed{214, 39, 40};

}  // namespace

host::Json to_json(const Estimate& estimate) {
  return {{"value", estimate.value}, {"std", estimate.std}};
}

host::Json to_json(const Refusal& refusal) {
  if (!refusal) { return nullptr; }
  return fmt::format("{}: {}", to_string(refusal.parameter), to_string(refusal.reason));
}

host::Json matrix_json(std::span<const double> elements) {
  const auto n =
      static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(elements.size()))));
  host::Json rows = host::Json::array();
  for (std::size_t i = 0; i < n; ++i) {
    host::Json row = host::Json::array();
    for (std::size_t j = 0; j < n; ++j) { row.push_back(elements[n * i + j]); }
    rows.push_back(row);
  }
  return rows;
}

host::Json joint_json(const JointReport& report) {
  const auto deviation = [&](std::size_t k) {
    return std::sqrt(std::max(0.0, report.covariance[7 * k]));
  };
  const DriveParameters& d = report.drive;
  return {{"axle", to_json(Estimate{d.track_m, deviation(2)})},
          {"l_diam", to_json(Estimate{2.0 * d.radius_left_m, 2.0 * deviation(0)})},
          {"r_diam", to_json(Estimate{2.0 * d.radius_right_m, 2.0 * deviation(1)})},
          {"l_x", to_json(Estimate{d.base_T_lidar.x_m, deviation(3)})},
          {"l_y", to_json(Estimate{d.base_T_lidar.y_m, deviation(4)})},
          {"l_theta", to_json(Estimate{d.base_T_lidar.theta_rad, deviation(5)})},
          {"covariance", matrix_json(report.covariance)},
          {"inlier_covariance", matrix_json(report.inlier_covariance)},
          {"condition", report.condition},
          {"samples", report.samples},
          {"samples_used", report.used},
          {"refused", to_json(report.refusal)}};
}

void draw_calibration(const std::filesystem::path& folder, const std::string& title,
                      const Residuals& residuals, const host::Trajectory& odometry,
                      const host::Trajectory& lidar, const host::Trajectory& corrected) {
  host::make_folder(folder);
  host::Picture scatter;
  scatter.title = title + ": " + residuals.title;
  scatter.note = fmt::format("{} {}", residuals.after_m.size(), residuals.note);
  if (!residuals.before_m.empty()) {
    scatter.points.push_back({residuals.before_m, kOdometryGreen, 2.0, "odometry as it was"});
  }
  scatter.points.push_back({residuals.after_m, kCorrectedRed, 2.0, "corrected"});
  write_picture(scatter, folder, "residuals");
  host::Picture path;
  path.title = title + ": path";
  path.note = fmt::format("{} poses{}", corrected.size(), residuals.path_note);
  path.lines.push_back(host::trajectory_line(odometry, kOdometryGreen, 2.0, "odometry"));
  path.lines.push_back(host::trajectory_line(lidar, kLidarYellow, 3.0, residuals.reference));
  path.lines.push_back(host::trajectory_line(corrected, kCorrectedRed, 2.0, "corrected odometry"));
  write_picture(path, folder, "path");
}

void print_calibration(const host::Json& json, bool as_json, const std::filesystem::path& folder) {
  host::make_folder(folder);
  const std::string text = host::to_text(json);
  host::write_file(folder / "calibration.json", text + "\n");
  if (as_json) {
    fmt::print("{}\n", text);
    return;
  }
  for (const auto& [key, value] : json.items()) {
    if (value.is_object() && value.contains("value")) {
      fmt::print("{:14} {:>14.9g}  +- {:.3g}\n", key, value["value"].get<double>(),
                 value["std"].get<double>());
    } else if (!value.is_array()) {
      fmt::print("{:14} {}\n", key, value.is_null() ? "no" : value.dump());
    }
  }
  fmt::print("written: {}\n", (folder / "calibration.json").string());
}

}  // namespace picolo::tool
