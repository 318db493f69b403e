// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "drive_files.hpp"

#include <fmt/format.h>

#include "picolo/host/files.hpp"
#include "picolo/host/picture.hpp"

namespace picolo::tool {
namespace {

std::string describe(const DriveResult& drive, const DriveErrors& errors) {
  std::string note =
      fmt::format("{} scans, {} matched", drive.trajectory.size(), drive.counters.matched);
  const ErrorStatistics& ape = errors.trajectory.statistics;
  if (ape.count > 0) {
    note += fmt::format("; APE rmse {:.3f} m, max {:.3f} m over {} poses; odometry {:.2f} m",
                        ape.rmse, ape.max, ape.count, errors.odometry.statistics.rmse);
  }
  return note;
}

host::Picture picture_of(const DriveResult& drive, const DriveErrors& errors,
                         const std::string& title) {
  host::Picture picture;
  picture.title = title;
  picture.note = describe(drive, errors);
  if (!drive.map.cells.empty()) { picture.maps.push_back(drive.map); }
  if (errors.trajectory.statistics.count > 0) {
    const Pose2d map_T_reference = inverse(errors.trajectory.reference_T_estimate);
    picture.lines.push_back(trajectory_line(host::transformed(map_T_reference, drive.truth),
                                            host::palette::kTruth, 5.0, drive.truth_name));
  }
  picture.lines.push_back(
      trajectory_line(drive.odometry, host::palette::kOdometry, 1.6, "wheel odometry"));
  picture.lines.push_back(trajectory_line(drive.trajectory, host::palette::kPicolo, 2.0, "picolo"));
  return picture;
}

}  // namespace

DriveErrors evaluate(const DriveResult& drive) {
  return {host::evaluate_ape(drive.truth, drive.trajectory),
          host::evaluate_ape(drive.truth, drive.odometry)};
}

void write_drive(const DriveResult& drive, const DriveErrors& errors, const std::string& title,
                 bool with_truth_file, const std::filesystem::path& folder) {
  host::make_folder(folder);
  write_tum(folder / "trajectory.tum", drive.trajectory);
  write_tum(folder / "odometry.tum", drive.odometry);
  if (with_truth_file) { write_tum(folder / "truth.tum", drive.truth); }
  write_map(folder, "map", drive.map);
  write_picture(picture_of(drive, errors, title), folder, "picture");
}

}  // namespace picolo::tool
