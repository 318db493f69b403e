// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <vector>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/calibration/joint_batch.hpp"
#include "picolo/calibration/joint_streaming.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

/// How much older the scans are than their stamps say; 0 where the log does not show it.
Estimate lidar_age(const DriveFile& drive, const std::vector<ScanStep>& steps) {
  const auto estimator = std::make_unique<TimeOffset<101, 4096, 4096>>();
  std::size_t next = 0;
  const auto wheels_until = [&](double stamp_s) {
    for (; next < drive.wheels.size() && drive.wheels[next].stamp_s <= stamp_s; ++next) {
      static_cast<void>(estimator->core().add_wheels(drive.wheels[next]));
    }
  };
  for (const ScanStep& step : steps) {
    const double end_s = drive.scans[step.scan].stamp_s;
    wheels_until(end_s);
    if (!step.converged) { continue; }
    static_cast<void>(estimator->core().add_rotation(drive.scans[step.scan - 1].stamp_s, end_s,
                                                     step.lidar_motion.theta_rad));
  }
  wheels_until(drive.wheels.back().stamp_s);
  TimeOffsetReport report;
  return is_ok(estimator->core().solve(report)) ? report.offset_s : Estimate{};
}

/// Rows T phi_l phi_r sm_x sm_y sm_theta, or a log with counters and scans that are matched here,
/// whose clocks are brought together first.
std::vector<MotionSample> samples_of(const DriveFile& drive, Estimate& age) {
  std::vector<MotionSample> samples;
  for (const auto& row : drive.pairs) {
    samples.push_back({row[0], row[1], row[2], {row[3], row[4], row[5]}});
  }
  if (!samples.empty() || drive.wheels.size() < 2) { return samples; }
  const std::vector<ScanStep> steps = match_scans(drive, {});
  age = lidar_age(drive, steps);
  for (const ScanStep& step : steps) {
    const double begin_s = drive.scans[step.scan - 1].stamp_s;
    const double end_s = drive.scans[step.scan].stamp_s;
    if (!step.converged || !(end_s > begin_s)) { continue; }
    const WheelAngles a = wheels_at(drive.wheels, begin_s - age.value);
    const WheelAngles b = wheels_at(drive.wheels, end_s - age.value);
    const double duration = end_s - begin_s;
    samples.push_back({duration, (b.left_rad - a.left_rad) / duration,
                       (b.right_rad - a.right_rad) / duration, step.lidar_motion});
  }
  return samples;
}

}  // namespace

void draw_joint(const std::vector<MotionSample>& samples, const DriveParameters& drive,
                const std::string& title, const std::string& folder) {
  const double mean = 0.5 * (drive.radius_left_m + drive.radius_right_m);
  DriveParameters before = drive;
  before.radius_left_m = before.radius_right_m = mean;
  Residuals residuals;
  host::Trajectory odometry, lidar, corrected;
  Pose2d a, b, c;
  double stamp_s = 0.0;
  const Pose2d& mount = drive.base_T_lidar;
  for (const MotionSample& sample : samples) {
    const Pose2d was = motion_residual(before, sample);
    const Pose2d is = motion_residual(drive, sample);
    residuals.before_m.push_back({was.x_m, was.y_m});
    residuals.after_m.push_back({is.x_m, is.y_m});
    a = a * base_motion(before, sample);
    b = b * (mount * sample.lidar_motion * inverse(mount));
    c = c * base_motion(drive, sample);
    stamp_s += sample.duration_s;
    odometry.push_back({stamp_s, a});
    lidar.push_back({stamp_s, b});
    corrected.push_back({stamp_s, c});
  }
  draw_calibration(folder, title, residuals, odometry, lidar, corrected);
}

ExitCode calibrate_joint_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const DriveFile drive = read_drive(options.file, options.ticks_per_turn, diagnostics);
  Estimate age;
  const std::vector<MotionSample> samples = samples_of(drive, age);
  if (samples.empty()) {
    throw host::UserError{
        ExitCode::input, drive.name, "holds no pair of scans with wheel counters around them",
        "give rows 'T phi_l phi_r sm_x sm_y sm_theta', or a log with TICKS and scans"};
  }
  JointReport report;
  if (options.single_pass) {
    JointStreaming streaming;
    for (const MotionSample& sample : samples) { static_cast<void>(streaming.add(sample)); }
    static_cast<void>(streaming.solve(report));
  } else {
    SpanSource<MotionSample> source{samples};
    const JointBatchConfig config{
        .outlier_rounds = options.outlier_rounds < 0 ? 4 : options.outlier_rounds,
        .quantile = options.quantile};
    if (calibrate_joint(source, config, report) == Status::invalid_argument) {
      throw host::UserError{ExitCode::usage, "command line",
                            "outlier rounds or quantile are out of their domain",
                            "0 to 8 rounds, quantile above 0.5 and at most 1"};
    }
  }
  draw_joint(samples, report.drive, "Wheels and lidar together", options.common.out);
  host::Json json = joint_json(report);
  if (drive.pairs.empty()) { json["time_offset"] = to_json(age); }
  print_calibration(json, options.common.json, options.common.out);
  return end_of_calibration(report.refusal, drive.name, drive.damage);
}

}  // namespace picolo::tool
