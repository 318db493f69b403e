// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration_file.hpp"
#include "commands.hpp"
#include "direct_replay.hpp"
#include "drive_files.hpp"
#include "live/folder_replay.hpp"
#include "matcher_replay.hpp"
#include "picolo/host/config_file.hpp"
#include "picolo/host/library_config.hpp"
#include "picolo/host/quantile.hpp"
#include "replay_input.hpp"
#include "wire_replay.hpp"

namespace picolo::tool {
namespace {

struct Options {
  CommonOptions common;
  std::string log;
  std::string reference;
  bool no_odometry = false;
  bool wire = false;
  std::optional<std::string> profile;
  std::optional<float> max_range_m;
  std::vector<double> lidar;
  std::string calibration;
  std::string map;
  std::vector<double> start;
  std::string save_map;
  std::string matcher;
  double ticks_per_turn = 0.0;
};

ReplaySettings settings_from(const Options& options) {
  ReplaySettings settings;
  host::ConfigFile file{options.common.config};
  read(file, "localiser", settings.localiser);
  file.read("replay", "profile", settings.profile);
  file.read("replay", "min_range_m", settings.min_range_m);
  file.read("replay", "max_range_m", settings.max_range_m);
  file.reject_unknown({"demo", "undistort"});
  settings.profile = options.profile.value_or(settings.profile);
  settings.max_range_m = options.max_range_m.value_or(settings.max_range_m);
  settings.use_odometry = !options.no_odometry;
  if (options.lidar.size() == 3) {
    settings.base_T_lidar = Pose2d{options.lidar[0], options.lidar[1], options.lidar[2]};
  }
  settings.map = options.map;
  settings.save_map = options.save_map;
  if (options.start.size() == 3) {
    settings.map_T_start = Pose2d{options.start[0], options.start[1], options.start[2]};
  }
  if (!options.matcher.empty() && (options.wire || !options.map.empty() ||
                                   !options.save_map.empty() || !options.start.empty())) {
    throw host::UserError{ExitCode::usage, "",
                          "--matcher runs a matcher alone, without controller, given map or start",
                          "leave out --wire, --map, --save-map and --start"};
  }
  if (!RangeLimits{settings.min_range_m, settings.max_range_m}.valid()) {
    throw host::UserError{ExitCode::usage, options.common.config,
                          "the range limits exclude every range", "min < max, both positive"};
  }
  return settings;
}

void report(const DriveResult& drive, const DriveErrors& errors, const Options& options) {
  const std::filesystem::path folder{options.common.out};
  const bool judged = !options.reference.empty();
  if (options.common.json) {
    host::Json json;
    json["scans"] = drive.trajectory.size();
    json["matched"] = drive.counters.matched;
    json["outcomes"] = outcomes_json(drive.counters);
    json["searched"] = drive.counters.searched;
    json["searched_wide"] = drive.counters.searched_wide;
    json["match_us"] = quantiles(drive.match_us);
    json["total_us"] = quantiles(drive.total_us);
    json["iterations"] = quantiles(drive.iterations);
    json["heap_calls"] = drive.heap_calls;
    if (options.matcher.empty()) { json["health"] = to_json(drive.health); }
    if (judged) {
      json["ape"] = to_json(errors.trajectory);
      json["ape_odometry"] = to_json(errors.odometry);
    }
    fmt::print("{}\n", host::to_text(json));
    return;
  }
  fmt::print("{} scans, {} matched, {} heap calls\n", drive.trajectory.size(),
             drive.counters.matched, drive.heap_calls);
  fmt::print("match {:.0f} us (p50) {:.0f} us (p99), whole scan {:.0f} us, {:.0f} us\n",
             host::quantile(drive.match_us, 0.5), host::quantile(drive.match_us, 0.99),
             host::quantile(drive.total_us, 0.5), host::quantile(drive.total_us, 0.99));
  if (judged) {
    const ErrorStatistics& ape = errors.trajectory.statistics;
    fmt::print(
        "APE rmse {:.4f} m, median {:.4f} m, max {:.4f} m over {} poses; odometry {:.3f} m\n",
        ape.rmse, ape.median, ape.max, ape.count, errors.odometry.statistics.rmse);
  }
  if (options.matcher.empty()) { fmt::print("{}", to_lines(drive.health)); }
  fmt::print("picture: {}\n", (folder / "picture.png").string());
}

ExitCode judge(const DriveResult& drive, const DriveErrors& errors, const Options& options) {
  if (!usable(drive)) {
    throw host::UserError{ExitCode::refused, options.log,
                          fmt::format("only {} of {} scans matched, the pose was lost",
                                      drive.counters.matched, drive.trajectory.size()),
                          "look at the picture; check range limits, lidar pose and odometry"};
  }
  if (!options.reference.empty() && errors.trajectory.statistics.count == 0) {
    throw host::UserError{
        ExitCode::refused, options.reference,
        fmt::format("no pose within {:g} s of a scan of the log", host::kAssociationTolerance_s),
        "is it the reference of this log?"};
  }
  return ExitCode::done;
}

DriveResult run(const ReplayInput& input, const ReplaySettings& settings, const Options& options,
                host::Diagnostics& diagnostics) {
  if (!options.matcher.empty()) {
    return replay_with_matcher(input, settings, matcher_kind(options.matcher));
  }
  return options.wire ? replay_through_wires(input, settings, diagnostics)
                      : replay_directly(input, settings);
}

void report_folder(const FolderReplay& replay, const Options& options) {
  if (options.common.json) {
    host::Json json;
    json["cycles"] = replay.journal.cycles();
    json["pose_hash"] = replay.journal.hash();
    json["recorded_cycles"] = replay.has_cycles;
    if (replay.has_result) { json["same"] = replay.same; }
    json["differences"] = replay.differences;
    json["matched"] = replay.drive.counters.matched;
    json["changes"] = replay.journal.changes_json();
    fmt::print("{}\n", host::to_text(json));
    return;
  }
  fmt::print("{} cycles{}, {} matched, pose hash {}\n", replay.journal.cycles(),
             replay.has_cycles ? "" : " by arrival times", replay.drive.counters.matched,
             replay.journal.hash());
  if (replay.has_result && replay.same) { fmt::print("the same as recorded, bit for bit\n"); }
  fmt::print("picture: {}\n", (std::filesystem::path{options.common.out} / "picture.png").string());
}

/// A folder that run, demo or simulate has recorded, or one of captures.
ExitCode replay_recording(const Options& options) {
  host::Diagnostics diagnostics;
  FolderReplay replay = replay_folder({options.log}, options.common.config, diagnostics);
  const bool any_pose = !replay.drive.trajectory.empty();
  if (!any_pose && !replay.same) {
    throw host::UserError{ExitCode::refused, options.log,
                          fmt::format("no pose in {} cycles", replay.journal.cycles()),
                          "does the configuration fit the vehicle (nodes, baud rates)?"};
  }
  host::TumFile reference;
  if (!options.reference.empty()) {
    host::LineReader reader{options.reference};
    reference = read_tum(reader, diagnostics);
  }
  replay.drive.truth = reference.poses;
  replay.drive.truth_name = "reference";
  const std::string name = std::filesystem::path{options.log}.filename().string();
  if (any_pose) {
    write_drive(replay.drive, evaluate(replay.drive), "Replay of " + name, false,
                options.common.out);
  }
  report_folder(replay, options);
  if (replay.has_result && !replay.same) {
    throw host::UserError{
        ExitCode::refused, options.log,
        fmt::format("gives other poses or frames than recorded ({} calls differ)",
                    replay.differences),
        "replay with the picolo and the configuration that recorded it; results by other "
        "settings are in the output folder"};
  }
  return ExitCode::done;
}

ExitCode replay(const Options& options) {
  if (std::filesystem::is_directory(options.log)) { return replay_recording(options); }
  ReplaySettings settings = settings_from(options);
  host::Diagnostics diagnostics;
  host::LineReader reader{options.log};
  host::CarmenLog log = read_carmen(reader, diagnostics);
  if (!options.calibration.empty()) {
    const CalibrationFile calibration = read_calibration(options.calibration);
    apply_to_odometry(calibration, options.log, options.ticks_per_turn, log);
    if (!settings.base_T_lidar) { settings.base_T_lidar = calibration.base_T_lidar; }
  }
  const ReplayInput input = prepare(log, settings, diagnostics);
  host::TumFile reference;
  if (!options.reference.empty()) {
    host::LineReader reference_reader{options.reference};
    reference = read_tum(reference_reader, diagnostics);
  }
  DriveResult drive = run(input, settings, options, diagnostics);
  drive.truth = reference.poses;
  drive.truth_name = "reference";
  const DriveErrors errors = evaluate(drive);
  const std::string name = std::filesystem::path{log.name}.filename().string();
  write_drive(drive, errors, "Replay of " + name, false, options.common.out);
  report(drive, errors, options);
  const ExitCode whole = end_of_input(log.name, log.damage);
  if (whole != ExitCode::done) { return whole; }
  const ExitCode whole_reference = end_of_input(reference.name, reference.damage);
  return whole_reference != ExitCode::done ? whole_reference : judge(drive, errors, options);
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "replay", "Localises a recorded drive: odometry and lidar scans in, poses out");
  command->add_option("LOG", options->log, "CARMEN log (.log, .clf), plain or .gz; - for a pipe")
      ->required();
  add_common_options(*command, options->common);
  command
      ->add_option("--reference", options->reference, "Reference poses to judge by (TUM, .gz too)")
      ->type_name("REF.tum");
  command->add_flag("--no-odometry", options->no_odometry,
                    "Do not give the log's odometry to the localiser");
  command->add_flag("--wire", options->wire,
                    "Play the log as CAN frames and lidar bytes into the installed controller");
  command
      ->add_option("--map", options->map,
                   "Localise only, in this map: YAML of ROS's map_server, or a file of --save-map")
      ->type_name("FILE");
  command
      ->add_option(
          "--start", options->start,
          "Pose of the vehicle in the map at the first scan, by default the log's odometry; with "
          "--map it decides between places that look alike")
      ->expected(3)
      ->type_name("X Y YAW");
  command
      ->add_option("--save-map", options->save_map,
                   "Also write the map's last window as the byte store of a vehicle holds it")
      ->type_name("FILE");
  command
      ->add_option("--matcher", options->matcher,
                   std::string{"This matcher alone instead of the estimator: "} + kMatcherNames)
      ->type_name("NAME");
  command->add_option("--profile", options->profile, "How much it remembers: room, hall or site")
      ->type_name("NAME");
  command->add_option("--max-range", options->max_range_m, "Longer ranges are no measurements")
      ->type_name("M");
  command
      ->add_option("--lidar", options->lidar,
                   "Pose of the lidar on the vehicle, instead of the log's")
      ->expected(3)
      ->type_name("X Y YAW");
  command
      ->add_option("--calibration", options->calibration,
                   "calibration.json of 'picolo calibrate': its 3x3 matrix corrects the odometry, "
                   "or its wheels turn the log's TICKS into odometry")
      ->type_name("FILE");
  command
      ->add_option("--ticks-per-turn", options->ticks_per_turn,
                   "As it was given to 'picolo calibrate'")
      ->check(CLI::NonNegativeNumber);
  command->footer(
      "Writes to the output folder: trajectory.tum (one pose a scan, stamps of the log),\n"
      "odometry.tum, map.pgm + map.yaml (for ROS's map_server), picture.svg and picture.png.\n"
      "\n"
      "Examples:\n"
      "  picolo replay freiburg-079.clf.gz\n"
      "  picolo replay freiburg-079.clf.gz --reference freiburg-079_ref.tum.gz --json\n"
      "      prints the error after alignment: \"ape\":{\"rmse\":...} in metres\n"
      "  picolo replay freiburg-101.clf.gz --wire\n"
      "      stop-and-scan in virtual time through drivers and cyclic executive\n"
      "  picolo replay /tmp/drive\n"
      "      a folder of run, demo or simulate --record: the same poses bit for bit; without\n"
      "      cycles.log, or with a candump log and raw captures, by arrival times\n"
      "  picolo calibrate linear intel.clf.gz --out cal\n"
      "  picolo replay intel.clf.gz --calibration cal/calibration.json\n"
      "  picolo replay monday.clf --out mon && picolo replay tuesday.clf --map mon/map.yaml\n"
      "      the second drive finds itself in the map of the first, which stays as it is\n"
      "  picolo replay intel.clf.gz --matcher ndt\n"
      "      odometry, one match a scan, map update: what a matcher does without the rest\n"
      "  picolo replay hand-held.clf.gz --no-odometry --out /tmp/lidar-only\n"
      "\n"
      "Records: FLASER, ROBOTLASER1 (scans with odometry), or SWEEP with ODOM; other lines are\n"
      "skipped. A log whose stamps do not increase runs on a clock of 0.1 s a scan.\n"
      "Settings in --config FILE: [replay] profile min_range_m max_range_m; [localiser] and its\n"
      "sub-sections map, coarse, fine, noise, search, heading: LocaliserConfig's fields by name.");
  command->callback([&action, options] { action = [options] { return replay(*options); }; });
}

}  // namespace picolo::tool
