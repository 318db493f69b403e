// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/calibration/track_batch.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

/// Dead reckoning as positions of the marker, at the stamps of the tracker.
host::Trajectory reckon(const DriveFile& drive, const DriveParameters& wheels,
                        const TrackReport& report) {
  host::Trajectory path;
  Pose2d pose = report.start;
  WheelAngles last = drive.wheels.front();
  for (const TrackPosition& seen : drive.track) {
    const WheelAngles now = wheels_at(drive.wheels, seen.stamp_s);
    pose =
        pose * base_motion(wheels,
                           {1.0, now.left_rad - last.left_rad, now.right_rad - last.right_rad, {}});
    last = now;
    path.push_back({seen.stamp_s, pose * Pose2d{report.marker_x_m, report.marker_y_m, 0.0}});
  }
  return path;
}

void draw(const DriveFile& drive, const CalibrateOptions& options, const TrackReport& report) {
  const host::Trajectory before = reckon(
      drive, {options.nominal_radius_m, options.nominal_radius_m, options.nominal_track_m, {}},
      report);
  const host::Trajectory after = reckon(
      drive, {report.radius_left_m.value, report.radius_right_m.value, report.track_m.value, {}},
      report);
  host::Trajectory seen;
  Residuals residuals;
  residuals.title = "dead reckoning minus tracker";
  residuals.note = "positions; metres";
  residuals.reference = "tracker";
  for (std::size_t k = 0; k < drive.track.size(); ++k) {
    const TrackPosition& p = drive.track[k];
    seen.push_back({p.stamp_s, {p.x_m, p.y_m, 0.0}});
    residuals.before_m.push_back({before[k].pose.x_m - p.x_m, before[k].pose.y_m - p.y_m});
    residuals.after_m.push_back({after[k].pose.x_m - p.x_m, after[k].pose.y_m - p.y_m});
  }
  draw_calibration(options.common.out, "Wheels against a tracker", residuals, before, seen, after);
}

}  // namespace

ExitCode calibrate_track_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const DriveFile drive = read_drive(options.file, options.ticks_per_turn, diagnostics);
  if (drive.wheels.size() < 2 || drive.track.empty()) {
    throw host::UserError{ExitCode::input, drive.name,
                          "needs wheel counters and positions of a tracker",
                          "give a log with TICKS lines and REFMM lines 't x y' (mm)"};
  }
  SpanSource<WheelAngles> wheels{drive.wheels};
  SpanSource<TrackPosition> all{drive.track};
  const auto part =
      static_cast<std::size_t>(options.fit_share * static_cast<double>(drive.track.size()));
  SpanSource<TrackPosition> fitted{std::span{drive.track}.first(part)};
  TrackReport report;
  static_cast<void>(calibrate_track(
      wheels, fitted, {.radius_m = options.nominal_radius_m, .track_m = options.nominal_track_m},
      report));
  const double rms_all_m = track_rms_m(wheels, all, report);
  draw(drive, options, report);
  print_calibration({{"r_L", to_json(report.radius_left_m)},
                     {"r_R", to_json(report.radius_right_m)},
                     {"b", to_json(report.track_m)},
                     {"marker_x", report.marker_x_m},
                     {"marker_y", report.marker_y_m},
                     {"start_x", report.start.x_m},
                     {"start_y", report.start.y_m},
                     {"start_theta", report.start.theta_rad},
                     {"rms_before_m", report.rms_before_m},
                     {"rms_after_m", report.rms_after_m},
                     {"rms_whole_recording_m", rms_all_m},
                     {"samples_used", report.positions},
                     {"refused", to_json(report.refusal)}},
                    options.common.json, options.common.out);
  return end_of_calibration(report.refusal, drive.name, drive.damage);
}

}  // namespace picolo::tool
