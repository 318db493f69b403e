// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "matcher_replay.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/picture.hpp"
#include "processor_time.hpp"
#include "replay_input.hpp"
#include "scan_matcher.hpp"

namespace picolo::tool {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

struct Options {
  CommonOptions common;
  std::string reference;
  std::string scan;
  std::string matcher = "plicp";
  std::vector<double> guess;
  bool no_odometry = false;
  std::vector<double> lidar;
  std::optional<float> max_range_m;
};

struct ScanName {
  std::string log;
  std::size_t index = 0;
};

/// "LOG:N", or "N" of the log named before.
ScanName parse_scan(const std::string& text, const std::string& log_before) {
  const std::size_t colon = text.rfind(':');
  ScanName name;
  name.log = colon == std::string::npos ? log_before : text.substr(0, colon);
  const std::string number = colon == std::string::npos ? text : text.substr(colon + 1);
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), name.index);
  if (name.log.empty() || number.empty() || error != std::errc{} ||
      end != number.data() + number.size()) {
    throw host::UserError{ExitCode::usage, "", "'" + text + "' names no scan",
                          "give LOG:NUMBER, the first scan is 0; the second may be a mere number"};
  }
  return name;
}

/// A scan with points of its own, at the instant of its first return.
struct ChosenScan {
  std::vector<float> x_m;
  std::vector<float> y_m;
  UndistortedSweep sweep{};
  Pose2d odom_T_base{};
  bool has_odometry = false;

  void keep(const UndistortedSweep& from) {
    x_m.assign(from.points.x_m.begin(), from.points.x_m.end());
    y_m.assign(from.points.y_m.begin(), from.points.y_m.end());
    sweep = from;
    sweep.points = {};
    sweep.points.x_m = x_m;
    sweep.points.y_m = y_m;
  }
};

void choose(const ScanName& name, const Options& options, host::Diagnostics& diagnostics,
            ChosenScan& chosen) {
  ReplaySettings settings;
  settings.use_odometry = !options.no_odometry;
  settings.max_range_m = options.max_range_m.value_or(settings.max_range_m);
  if (options.lidar.size() == 3) {
    settings.base_T_lidar = Pose2d{options.lidar[0], options.lidar[1], options.lidar[2]};
  }
  host::LineReader reader{name.log};
  const host::CarmenLog log = read_carmen(reader, diagnostics);
  const ReplayInput input = prepare(log, settings, diagnostics);
  if (name.index >= input.scans.size()) {
    throw host::UserError{ExitCode::usage, name.log, fmt::format("has no scan {}", name.index),
                          fmt::format("its scans are 0 to {}", input.scans.size() - 1)};
  }
  const ReplayScan& scan = input.scans[name.index];
  const auto points = std::make_unique<ScanPoints>(input);
  const UndistortedSweep* sweep = nullptr;
  for (std::size_t k = 0; k <= name.index; ++k) { sweep = points->of(input.scans[k]); }
  if (sweep == nullptr) {
    throw host::UserError{ExitCode::refused, name.log,
                          fmt::format("line {}: odometry does not cover the scan", scan.line),
                          "choose a later one"};
  }
  chosen.keep(*sweep);
  chosen.odom_T_base = sweep->odom_T_base;
  chosen.has_odometry = input.use_odometry;
}

struct MatchResult {
  Pose2d guess{};
  ScanMatch match{};
  double time_us = 0.0;
};

std::vector<Point2<double>> placed(const ChosenScan& scan, const Pose2d& pose) {
  std::vector<Point2<double>> points_m;
  for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
    const Pose2d point = pose * Pose2d{scan.x_m[k], scan.y_m[k], 0.0};
    points_m.push_back({point.x_m, point.y_m});
  }
  return points_m;
}

std::string pose_text(const Pose2d& pose) {
  return fmt::format("x {:.4f} m, y {:.4f} m, {:.3f} deg", pose.x_m, pose.y_m,
                     pose.theta_rad * kDegreesPerRadian);
}

void draw(const ChosenScan& reference, const ChosenScan& scan, const MatchResult& result,
          const Options& options) {
  host::Picture picture;
  picture.title = "Match of " + std::filesystem::path{options.scan}.filename().string() + " with " +
                  std::filesystem::path{options.reference}.filename().string();
  picture.note =
      fmt::format("{}: {}; {}, {} iterations, {:.0f} % of {} points near",
                  title_of(matcher_kind(options.matcher)), to_string(result.match.report.outcome),
                  pose_text(result.match.map_T_base), result.match.report.iterations,
                  100.0 * static_cast<double>(result.match.report.inlier_share), scan.x_m.size());
  picture.points.push_back({placed(reference, {}), host::palette::kInk, 2.4, "reference"});
  picture.points.push_back(
      {placed(scan, result.guess), host::palette::kOdometry, 1.3, "scan at the guess"});
  picture.points.push_back(
      {placed(scan, result.match.map_T_base), host::palette::kPicolo, 1.6, "scan as matched"});
  host::make_folder(options.common.out);
  write_picture(picture, options.common.out, "match");
}

void report(const MatchResult& result, const ChosenScan& scan, const Options& options) {
  const MatchReport& report = result.match.report;
  const Pose2d& pose = result.match.map_T_base;
  const auto sigma = [&](std::size_t k) {
    return std::sqrt(static_cast<double>(result.match.covariance(k, k)));
  };
  const auto pose_json = [](const Pose2d& p) {
    return host::Json{{"x_m", p.x_m}, {"y_m", p.y_m}, {"theta_rad", p.theta_rad}};
  };
  if (options.common.json) {
    host::Json covariance = host::Json::array();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) { covariance.push_back(result.match.covariance(i, j)); }
    }
    fmt::print("{}\n", host::to_text({{"matcher", options.matcher},
                                      {"outcome", to_string(report.outcome)},
                                      {"guess", pose_json(result.guess)},
                                      {"pose", pose_json(pose)},
                                      {"covariance", covariance},
                                      {"iterations", report.iterations},
                                      {"points", scan.x_m.size()},
                                      {"inlier_share", report.inlier_share},
                                      {"mean_residual_m", report.mean_residual_m},
                                      {"match_us", result.time_us}}));
    return;
  }
  fmt::print("{}: {} after {} iterations, {:.0f} us\n", options.matcher, to_string(report.outcome),
             report.iterations, result.time_us);
  fmt::print("guess   {}\nmatched {}\n", pose_text(result.guess), pose_text(pose));
  fmt::print(
      "sigma   x {:.4f} m, y {:.4f} m, {:.3f} deg; {:.0f} % of {} points near the reference\n",
      sigma(0), sigma(1), sigma(2) * kDegreesPerRadian,
      100.0 * static_cast<double>(report.inlier_share), scan.x_m.size());
  fmt::print("picture: {}\n", (std::filesystem::path{options.common.out} / "match.png").string());
}

ExitCode match(const Options& options) {
  const MatcherKind kind = matcher_kind(options.matcher);
  const ScanName reference_name = parse_scan(options.reference, "");
  const ScanName scan_name = parse_scan(options.scan, reference_name.log);
  host::Diagnostics diagnostics;
  ChosenScan reference;
  ChosenScan scan;
  choose(reference_name, options, diagnostics, reference);
  choose(scan_name, options, diagnostics, scan);
  MatchResult result;
  if (options.guess.size() == 3) {
    result.guess = {options.guess[0], options.guess[1], options.guess[2]};
  } else if (reference.has_odometry && scan.has_odometry && reference_name.log == scan_name.log) {
    result.guess = between(reference.odom_T_base, scan.odom_T_base);
  }
  const LocaliserConfig config;
  const auto map = std::make_unique<ScanMap>(fine_map_config<SiteProfile>(config.map));
  const auto matcher = make_scan_matcher(kind, config, map->core());
  map->core().reset(0.0, 0.0);
  matcher->follow({});
  matcher->add(reference.sweep, {});
  insert_scan(map->core(), reference.sweep, {}, config);
  // A guess is a guess: it shall not hold the answer.
  constexpr GuessSigma kHardlyAnything{.translation_m = 10.0F, .rotation_rad = 10.0F};
  const double begin_us = processor_time_us();
  result.match = matcher->match(scan.sweep, result.guess, kHardlyAnything);
  result.time_us = processor_time_us() - begin_us;
  draw(reference, scan, result, options);
  report(result, scan, options);
  const MatchOutcome outcome = result.match.report.outcome;
  if (outcome == MatchOutcome::converged || outcome == MatchOutcome::iteration_limit) {
    return ExitCode::done;
  }
  throw host::UserError{ExitCode::refused, options.scan,
                        fmt::format("the match is no pose: {}", to_string(outcome)),
                        "look at the picture; give a better --guess, or another --matcher"};
}

}  // namespace

void add_match(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("match", "Matches two scans of a log and draws both");
  command->add_option("REF", options->reference, "LOG:NUMBER, the first scan of a log is 0")
      ->required();
  command->add_option("SCAN", options->scan, "LOG:NUMBER, or NUMBER of the same log")->required();
  add_common_options(*command, options->common);
  command->add_option("--matcher", options->matcher, kMatcherNames)
      ->capture_default_str()
      ->type_name("NAME");
  command
      ->add_option("--guess", options->guess,
                   "Pose of SCAN in REF's frame to start from: metres, rad; by default as the "
                   "log's odometry has it")
      ->expected(3)
      ->type_name("X Y YAW");
  command->add_flag("--no-odometry", options->no_odometry, "Start from the same pose instead");
  command->add_option("--lidar", options->lidar, "Pose of the lidar, instead of the log's")
      ->expected(3)
      ->type_name("X Y YAW");
  command->add_option("--max-range", options->max_range_m, "Longer ranges are no measurements")
      ->type_name("M");
  command->footer(
      "Prints the pose of SCAN's vehicle in the frame of REF's, with its uncertainty; writes\n"
      "match.svg and match.png: reference black, scan at the guess red, as matched green.\n"
      "\n"
      "Examples:\n"
      "  picolo match freiburg-079.clf.gz:100 105\n"
      "  picolo match intel.clf.gz:10 intel.clf.gz:11 --matcher correlative\n"
      "  picolo match a.clf:0 b.clf:7 --guess 0.3 0 0.1 --json\n"
      "\n"
      "plicp matches scan to scan; gn, lm and correlative match against a map, ndt against normal\n"
      "distributions, that REF alone has made. correlative needs no good guess: it searches\n"
      "+-0.6 m and +-35 deg about it.");
  command->callback([&action, options] { action = [options] { return match(*options); }; });
}

}  // namespace picolo::tool
