// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands/calibrate.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace picolo::tool {
namespace {

CLI::App* subcommand(CLI::App& parent, const char* name, const char* what,
                     CalibrateOptions& options, Action& action,
                     ExitCode (*run)(const CalibrateOptions&),
                     const std::shared_ptr<CalibrateOptions>& owner) {
  CLI::App* command = parent.add_subcommand(name, what);
  add_common_options(*command, options.common);
  command->callback([&action, owner, run] { action = [owner, run] { return run(*owner); }; });
  return command;
}

void take_file(CLI::App& command, CalibrateOptions& options, const char* what) {
  command.add_option("FILE", options.file, what)->required();
  command
      .add_option("--ticks-per-turn", options.ticks_per_turn,
                  "Counts of a wheel's turn; 0: angles in counts, radii in metres a count")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

ExitCode end_of_calibration(const Refusal& refusal, const std::string& name,
                            const std::string& damage) {
  const ExitCode end = end_of_input(name, damage);
  if (!refusal) { return end; }
  fmt::print(stderr, "picolo: {}: refused: {} is not determined: {}\n", name,
             to_string(refusal.parameter), to_string(refusal.reason));
  return ExitCode::refused;
}

void add_calibrate(CLI::App& app, Action& action) {
  CLI::App* group =
      app.add_subcommand("calibrate", "Wheels, lidar pose and clock offsets from a recorded drive");
  group->require_subcommand(1);
  const auto options = std::make_shared<CalibrateOptions>();
  CalibrateOptions& o = *options;

  CLI::App* wheels =
      subcommand(*group, "wheels", "Wheel radii and track width from wheel rates and scan motions",
                 o, action, calibrate_wheels_command, options);
  wheels
      ->add_option("--odometry", o.odometry,
                   "Rows 't w_left w_right', rad/s; each covers the interval that ends at t")
      ->required();
  wheels
      ->add_option("--scan-match", o.scan_match,
                   "Rows 't dx dy dtheta': motion since the row before")
      ->required();
  wheels->add_option("--limit", o.limit, "Use the first N scan rows only; 0: all")
      ->capture_default_str();
  wheels->add_flag("--single-pass", o.single_pass, "As on the target: one pass, constant memory");

  CLI::App* joint = subcommand(
      *group, "joint", "Wheel radii, track width and lidar pose together (Censi et al. 2013)", o,
      action, calibrate_joint_command, options);
  take_file(*joint, o, "Rows 'T phi_l phi_r sm_x sm_y sm_theta', or a log with TICKS and scans");
  joint->add_option("--outlier-rounds", o.outlier_rounds, "Rounds of outlier rejection (4)")
      ->check(CLI::NonNegativeNumber);
  joint->add_option("--quantile", o.quantile, "Share of errors that a round keeps")
      ->capture_default_str();
  joint->add_flag("--single-pass", o.single_pass, "As on the target: one pass, constant memory");

  CLI::App* linear = subcommand(*group, "linear", "The 3x3 matrix X of scan = X odometry", o,
                                action, calibrate_linear_command, options);
  take_file(*linear, o,
            "Rows 'odom x y theta, scan x y theta', or a log whose scans carry odometry");

  linear
      ->add_option("--outlier-rounds", o.outlier_rounds,
                   "Rounds of outlier rejection (rows 0, logs 2)")
      ->check(CLI::NonNegativeNumber);

  CLI::App* extrinsic =
      subcommand(*group, "extrinsic", "Lidar yaw, then x and y, against calibrated odometry", o,
                 action, calibrate_extrinsic_command, options);
  take_file(*extrinsic, o,
            "Rows 'odom x y theta, scan x y theta', or a log whose scans carry odometry");

  CLI::App* offset =
      subcommand(*group, "time-offset", "How much older lidar or gyro data is than its stamps", o,
                 action, calibrate_time_offset_command, options);
  take_file(*offset, o, "Log with TICKS or ENC lines, and scans or IMU lines");
  offset->add_option("--max-offset", o.max_offset_s, "Search so far to both sides, seconds")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);

  CLI::App* track =
      subcommand(*group, "track", "Wheel radii and track width from positions that a tracker saw",
                 o, action, calibrate_track_command, options);
  take_file(*track, o, "Log with TICKS lines and REFMM lines 't x y' (mm) of a tracker");
  track->add_option("--nominal-radius", o.nominal_radius_m, "Of both wheels, before (0.1)")
      ->check(CLI::PositiveNumber);
  track->add_option("--nominal-track", o.nominal_track_m, "Track width before (0.5)")
      ->check(CLI::PositiveNumber);
  track
      ->add_option("--fit-share", o.fit_share,
                   "Share of the recording that is fitted; the rest only judges")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1.0));

  CLI::App* routine = subcommand(
      *group, "routine", "A log through the routine that runs on the target while one drives", o,
      action, calibrate_routine_command, options);
  take_file(*routine, o, "Log with TICKS or ENC lines and scans; IMU lines where there is a gyro");
  routine
      ->add_option("--collect", o.collect_share,
                   "Share of the log to collect from; the rest verifies the solution")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1.0));

  subcommand(*group, "memory", "Bytes of state of every single-pass estimator", o, action,
             calibrate_memory_command, options);

  group->footer(
      "Prints each value with its standard deviation, or why the drive does not determine it (exit "
      "code 1).\n"
      "\n"
      "Examples:\n"
      "  picolo calibrate wheels --odometry odom.txt.gz --scan-match scan_match.txt.gz --limit "
      "5000\n"
      "  picolo calibrate joint tuples.txt.gz --json\n"
      "  picolo calibrate time-offset drive.clf.gz --ticks-per-turn 2000\n"
      "  picolo calibrate routine drive.clf.gz --ticks-per-turn 2000\n"
      "\n"
      "Files may be .gz. Pictures (residuals, path: odometry green, lidar yellow, corrected red) "
      "and\n"
      "calibration.json go to the folder --out.");
}

}  // namespace picolo::tool
