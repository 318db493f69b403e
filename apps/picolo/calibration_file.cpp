// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "calibration_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "commands/calibrate_files.hpp"
#include "picolo/calibration/linear_batch.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"
#include "picolo/odometry/differential_drive.hpp"
#include "picolo/undistort/pose_buffer.hpp"

namespace picolo::tool {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& cause,
                         const std::string& cure) {
  throw host::UserError{host::ExitCode::input, name, cause, cure};
}

/// The number under `key`, or that of an estimate there.
double number(const host::Json& json, const char* key) {
  const host::Json& entry = json.at(key);
  return entry.is_object() ? entry.at("value").get<double>() : entry.get<double>();
}

Matrix3d matrix(const host::Json& rows) {
  Matrix3d x;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) { x(i, j) = rows.at(i).at(j).get<double>(); }
  }
  return x;
}

void take(const host::Json& json, CalibrationFile& file) {
  if (json.contains("X")) {
    file.correction = matrix(json.at("X"));
  } else if (json.contains("r_L")) {
    file.wheels = DriveParameters{number(json, "r_L"), number(json, "r_R"), number(json, "b"), {}};
  } else {
    file.base_T_lidar = Pose2d{number(json, "l_x"), number(json, "l_y"), number(json, "l_theta")};
    file.wheels = DriveParameters{0.5 * number(json, "l_diam"), 0.5 * number(json, "r_diam"),
                                  number(json, "axle"), *file.base_T_lidar};
  }
}

using Track = std::vector<StampedPose>;

Track reckon(const CalibrationFile& calibration, const DriveFile& drive) {
  // Angles come scaled to radians (or counts taken for radians); counts again, fine enough to keep
  // every digit of them.
  constexpr double kCountsPerRadian = 1e6;
  const DriveParameters& wheels = *calibration.wheels;
  DifferentialDrive odometry{{.left_radius_m = wheels.radius_left_m,
                              .right_radius_m = wheels.radius_right_m,
                              .track_m = wheels.track_m,
                              .counts_per_revolution = 2.0 * std::numbers::pi * kCountsPerRadian}};
  Track track;
  for (const WheelAngles& angles : drive.wheels) {
    WheelTicks ticks{.stamp = Timestamp{from_seconds(angles.stamp_s)}};
    ticks.ticks[0] = std::llround(angles.left_rad * kCountsPerRadian);
    ticks.ticks[1] = std::llround(angles.right_rad * kCountsPerRadian);
    const Result<WheelIncrement> step = odometry.update(ticks);
    if (step) {
      track.push_back({ticks.stamp, track.back().odom_T_base * step->from_T_to});
    } else if (track.empty()) {
      track.push_back({ticks.stamp, Pose2d{}});
    }
  }
  return track;
}

Pose2d at(const Track& track, double stamp_s) {
  const Timestamp stamp{from_seconds(stamp_s)};
  const auto after =
      std::upper_bound(track.begin(), track.end(), stamp,
                       [](Timestamp t, const StampedPose& pose) { return t < pose.stamp; });
  if (after == track.begin()) { return track.front().odom_T_base; }
  if (after == track.end()) { return track.back().odom_T_base; }
  const StampedPose& before = *(after - 1);
  return interpolate(
      before.odom_T_base, after->odom_T_base,
      to_seconds_f64(stamp - before.stamp) / to_seconds_f64(after->stamp - before.stamp));
}

/// The steps between the records, each corrected, from the first pose on.
template <typename Record>
void correct_steps(std::vector<Record>& records, const Matrix3d& correction) {
  if (records.empty()) { return; }
  Pose2d last = records.front().odom_T_base;
  Pose2d corrected = last;
  for (Record& record : records) {
    const Pose2d step = corrected_by(correction, between(last, record.odom_T_base));
    last = record.odom_T_base;
    corrected = corrected * step;
    record.odom_T_base = corrected;
  }
}

}  // namespace

CalibrationFile read_calibration(const std::string& path) {
  const std::string cure = "give the calibration.json that 'picolo calibrate' wrote";
  const host::Json json = host::Json::parse(host::read_file(path, cure), nullptr, false);
  if (!json.is_object()) { refuse(path, "is no JSON object", cure); }
  if (json.contains("refused") && json["refused"].is_string()) {
    refuse(path, "the calibration was refused: " + json["refused"].get<std::string>(),
           "drive what was missing, and calibrate again");
  }
  CalibrationFile file{.name = path, .correction = {}, .wheels = {}, .base_T_lidar = {}};
  try {
    take(json, file);
  } catch (const host::Json::exception&) {
    refuse(path, "holds neither X, nor r_L r_R b, nor axle l_diam r_diam l_x l_y l_theta",
           "give the calibration.json of 'picolo calibrate linear, wheels, joint or routine'");
  }
  return file;
}

void apply_to_odometry(const CalibrationFile& calibration, const std::string& path,
                       double ticks_per_turn, host::CarmenLog& log) {
  if (calibration.correction) {
    correct_steps(log.scans, *calibration.correction);
    correct_steps(log.odometry, *calibration.correction);
    return;
  }
  host::Diagnostics quiet{
      [](std::string_view) {}};  // the log's lines were judged when it was read first
  const DriveFile drive = read_drive(path, ticks_per_turn, quiet);
  const Track track = reckon(calibration, drive);
  if (track.size() < 2) {
    refuse(path, "holds no TICKS records for the wheels of " + calibration.name,
           "a log with poses only takes the 3x3 matrix of 'picolo calibrate linear'");
  }
  for (host::LogScan& scan : log.scans) {
    scan.odom_T_base = at(track, scan.stamp_s);
    scan.has_odometry = true;
  }
  for (host::LogOdometry& record : log.odometry) { record.odom_T_base = at(track, record.stamp_s); }
}

}  // namespace picolo::tool
