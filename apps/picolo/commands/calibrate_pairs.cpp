// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// calibrate linear and calibrate extrinsic: both work on displacements seen twice, by odometry and
// by scans.
#include <vector>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/calibration/extrinsic_calibration.hpp"
#include "picolo/calibration/linear_batch.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

/// Rows odom_x odom_y odom_theta scan_x scan_y scan_theta, or a log whose scans carry odometry and
/// are matched here.
std::vector<MotionPair> pairs_of(const DriveFile& drive) {
  std::vector<MotionPair> pairs;
  for (const auto& row : drive.pairs) {
    pairs.push_back({{row[0], row[1], row[2]}, {row[3], row[4], row[5]}});
  }
  if (!pairs.empty()) { return pairs; }
  for (const ScanStep& step : match_scans(drive, {})) {
    const PointScan& before = drive.scans[step.scan - 1];
    const PointScan& now = drive.scans[step.scan];
    if (!step.converged || !before.has_odometry || !now.has_odometry) { continue; }
    pairs.push_back({between(before.odom_T_base, now.odom_T_base), step.lidar_motion});
  }
  if (pairs.empty()) {
    throw host::UserError{ExitCode::input, drive.name, "holds no pair of scans with odometry",
                          "give rows 'odom x y theta, scan x y theta', or a log with FLASER or "
                          "ROBOTLASER1 and odometry"};
  }
  return pairs;
}

template <typename Correct>
void draw(const std::vector<MotionPair>& pairs, const std::string& title, const std::string& folder,
          Correct correct) {
  Residuals residuals;
  host::Trajectory odometry, lidar, corrected;
  Pose2d a, b, c;
  double count = 0.0;
  for (const MotionPair& pair : pairs) {
    const Pose2d better = correct(pair.odometry);
    residuals.before_m.push_back(
        {pair.scan.x_m - pair.odometry.x_m, pair.scan.y_m - pair.odometry.y_m});
    residuals.after_m.push_back({pair.scan.x_m - better.x_m, pair.scan.y_m - better.y_m});
    a = a * pair.odometry;
    b = b * pair.scan;
    c = c * better;
    count += 1.0;
    odometry.push_back({count, a});
    lidar.push_back({count, b});
    corrected.push_back({count, c});
  }
  draw_calibration(folder, title, residuals, odometry, lidar, corrected);
}

}  // namespace

ExitCode calibrate_linear_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const DriveFile drive = read_drive(options.file, options.ticks_per_turn, diagnostics);
  const std::vector<MotionPair> pairs = pairs_of(drive);
  // Rows are taken as they are; matches of a log are sometimes wrong.
  const int rounds =
      options.outlier_rounds >= 0 ? options.outlier_rounds : (drive.pairs.empty() ? 2 : 0);
  SpanSource<MotionPair> source{pairs};
  LinearReport report;
  if (calibrate_linear(source, {.outlier_rounds = rounds}, report) == Status::invalid_argument) {
    throw host::UserError{ExitCode::usage, "command line", "outlier rounds are out of their domain",
                          "0 to 8 rounds"};
  }
  draw(pairs, "Linear correction", options.common.out,
       [&](const Pose2d& o) { return corrected_by(report.correction, o); });
  print_calibration({{"X", matrix_json(report.correction.elements)},
                     {"std", matrix_json(report.deviation.elements)},
                     {"covariance", matrix_json(report.covariance)},
                     {"condition", report.condition},
                     {"rms_before_m", report.rms_before_m},
                     {"rms_after_m", report.rms_after_m},
                     {"samples_used", report.samples},
                     {"refused", to_json(report.refusal)}},
                    options.common.json, options.common.out);
  return end_of_calibration(report.refusal, drive.name, drive.damage);
}

ExitCode calibrate_extrinsic_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const DriveFile drive = read_drive(options.file, options.ticks_per_turn, diagnostics);
  const std::vector<MotionPair> pairs = pairs_of(drive);
  ExtrinsicCalibration calibration;
  for (const MotionPair& pair : pairs) { static_cast<void>(calibration.add(pair)); }
  ExtrinsicReport report;
  static_cast<void>(calibration.solve(report));
  const Pose2d mount{report.x_m.value, report.y_m.value, report.yaw_rad.value};
  draw(pairs, "Lidar pose", options.common.out,
       [&](const Pose2d& o) { return inverse(mount) * o * mount; });
  print_calibration({{"yaw", to_json(report.yaw_rad)},
                     {"x", to_json(report.x_m)},
                     {"y", to_json(report.y_m)},
                     {"scale", report.yaw_scale},
                     {"condition", report.condition},
                     {"samples_straight", report.straight},
                     {"samples_used", report.samples},
                     {"refused", to_json(report.yaw_refusal)},
                     {"position_refused", to_json(report.position_refusal)}},
                    options.common.json, options.common.out);
  return end_of_calibration(report.yaw_refusal, drive.name, drive.damage);
}

}  // namespace picolo::tool
