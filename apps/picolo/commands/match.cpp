// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "commands.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/picture.hpp"
#include "scan_pair.hpp"

namespace picolo::tool {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

struct Options {
  CommonOptions common;
  std::string reference;
  std::string scan;
  std::string matcher = "plicp";
  std::vector<double> guess;
  std::string pairs;
  std::vector<double> disturb;
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

ReplaySettings settings_of(const Options& options) {
  ReplaySettings settings;
  settings.use_odometry = !options.no_odometry;
  settings.max_range_m = options.max_range_m.value_or(settings.max_range_m);
  if (options.lidar.size() == 3) {
    settings.base_T_lidar = Pose2d{options.lidar[0], options.lidar[1], options.lidar[2]};
  }
  return settings;
}

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

void draw(const ChosenScan& reference, const ChosenScan& scan, const PairMatch& result,
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

void report(const PairMatch& result, const ChosenScan& scan, const Options& options) {
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
  if (!options.pairs.empty()) {
    PairsOptions pairs{.log = options.reference,
                       .pairs = options.pairs,
                       .matcher = options.matcher,
                       .json = options.common.json};
    if (options.disturb.size() == 2) {
      pairs.off_m = options.disturb[0];
      pairs.off_rad = options.disturb[1] / kDegreesPerRadian;
    }
    match_pairs(pairs, settings_of(options));
    return ExitCode::done;
  }
  const MatcherKind kind = matcher_kind(options.matcher);
  const ScanName reference_name = parse_scan(options.reference, "");
  const ScanName scan_name = parse_scan(options.scan, reference_name.log);
  const bool one_log = reference_name.log == scan_name.log;
  host::Diagnostics diagnostics;
  std::set<std::size_t> numbers{reference_name.index};
  if (one_log) { numbers.insert(scan_name.index); }
  const auto references =
      read_scans(reference_name.log, numbers, settings_of(options), diagnostics);
  std::map<std::size_t, ChosenScan> others;
  if (!one_log) {
    others = read_scans(scan_name.log, {scan_name.index}, settings_of(options), diagnostics);
  }
  const ChosenScan& reference = references.at(reference_name.index);
  const ChosenScan& scan = (one_log ? references : others).at(scan_name.index);
  Pose2d guess{};
  if (options.guess.size() == 3) {
    guess = {options.guess[0], options.guess[1], options.guess[2]};
  } else if (one_log && reference.has_odometry && scan.has_odometry) {
    guess = between(reference.sweep.odom_T_base, scan.sweep.odom_T_base);
  }
  const PairMatch result = PairMatcher{kind}.match(reference, scan, guess);
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
  command
      ->add_option("REF", options->reference,
                   "LOG:NUMBER, the first scan of a log is 0; with --pairs LOG")
      ->required();
  CLI::Option* scan =
      command->add_option("SCAN", options->scan, "LOG:NUMBER, or NUMBER of the same log");
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
  CLI::Option* pairs =
      command
          ->add_option("--pairs", options->pairs,
                       "Every pair of this file instead, lines of i j dx dy dtheta: how far the "
                       "matches lie from it")
          ->excludes(scan)
          ->type_name("FILE");
  command
      ->add_option("--disturb", options->disturb,
                   "With --pairs: how far off each guess is, in m and deg [0.2 10]")
      ->needs(pairs)
      ->expected(2)
      ->type_name("M DEG");
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
      "  picolo match intel_corrected_rt.clf.gz --pairs intel_pairs.txt --matcher gn\n"
      "\n"
      "plicp matches scan to scan; gn, lm and correlative match against a map, ndt against normal\n"
      "distributions, that REF alone has made. correlative needs no good guess: it searches\n"
      "+-0.6 m and +-35 deg about it.");
  command->callback([&action, options] { action = [options] { return match(*options); }; });
}

}  // namespace picolo::tool
