// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/calibration/wheel_batch.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/calibration/wheel_streaming.hpp"
#include "picolo/calibration/wheel_walk.hpp"

namespace picolo::tool {
namespace {

struct Path {
  Residuals residuals;
  host::Trajectory odometry;
  host::Trajectory lidar;
  host::Trajectory corrected;
};

/// Both wheels alike, as a vehicle knows itself before calibration, against the calibrated ones.
Path path_of(WheelWalk& walk, const WheelReport& report, std::uint64_t limit) {
  const double mean = 0.5 * (report.radius_left_m.value + report.radius_right_m.value);
  const DriveParameters before{mean, mean, report.track_m.value, {}};
  const DriveParameters after{
      report.radius_left_m.value, report.radius_right_m.value, report.track_m.value, {}};
  Path path;
  Pose2d odometry, lidar, corrected, step_before, step_after;
  WheelStretch stretch;
  ScanMotion scan;
  walk.rewind(limit);
  while (walk.next(stretch, scan)) {
    const MotionSample sample{stretch.duration_s, stretch.left_radps, stretch.right_radps, {}};
    step_before = step_before * base_motion(before, sample);
    step_after = step_after * base_motion(after, sample);
    if (!stretch.closes) { continue; }
    path.residuals.before_m.push_back(
        {scan.motion.x_m - step_before.x_m, scan.motion.y_m - step_before.y_m});
    path.residuals.after_m.push_back(
        {scan.motion.x_m - step_after.x_m, scan.motion.y_m - step_after.y_m});
    odometry = odometry * step_before;
    corrected = corrected * step_after;
    lidar = lidar * scan.motion;
    path.odometry.push_back({scan.stamp_s, odometry});
    path.lidar.push_back({scan.stamp_s, lidar});
    path.corrected.push_back({scan.stamp_s, corrected});
    step_before = step_after = Pose2d{};
  }
  return path;
}

}  // namespace

ExitCode calibrate_wheels_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const NumberFile odometry = read_numbers(options.odometry, 3, diagnostics);
  const NumberFile scan_match = read_numbers(options.scan_match, 4, diagnostics);
  std::vector<WheelRates> rates;
  for (const auto& row : odometry.rows) { rates.push_back({row[0], row[1], row[2]}); }
  std::vector<ScanMotion> scans;
  for (const auto& row : scan_match.rows) { scans.push_back({row[0], {row[1], row[2], row[3]}}); }
  SpanSource<WheelRates> rate_source{rates};
  SpanSource<ScanMotion> scan_source{scans};
  const WheelBatchConfig config{.limit = options.limit};
  WheelReport report;
  WheelWalk walk{rate_source, scan_source};
  if (options.single_pass) {
    WheelStreaming streaming{config};
    WheelStretch stretch;
    ScanMotion scan;
    walk.rewind(options.limit);
    while (walk.next(stretch, scan)) { streaming.add(stretch, scan); }
    static_cast<void>(streaming.solve(report));  // the report says it all
  } else {
    static_cast<void>(calibrate_wheels(rate_source, scan_source, config, report));
  }
  const Path path = path_of(walk, report, options.limit);
  draw_calibration(options.common.out, "Wheels", path.residuals, path.odometry, path.lidar,
                   path.corrected);
  print_calibration({{"J21", to_json(report.j21)},
                     {"J22", to_json(report.j22)},
                     {"b", to_json(report.track_m)},
                     {"r_L", to_json(report.radius_left_m)},
                     {"r_R", to_json(report.radius_right_m)},
                     {"covariance", matrix_json(report.covariance)},
                     {"condition", report.condition},
                     {"samples_used", report.used},
                     {"refused", to_json(report.refusal)}},
                    options.common.json, options.common.out);
  return end_of_calibration(report.refusal, odometry.name,
                            odometry.damage.empty() ? scan_match.damage : odometry.damage);
}

}  // namespace picolo::tool
