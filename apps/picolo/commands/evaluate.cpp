// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "commands.hpp"
#include "commands/evaluate_metrics.hpp"
#include "picolo/host/chart.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/picture.hpp"

namespace picolo::tool {
namespace {

struct Options {
  std::string reference;
  std::string estimate;
  std::string out;
  bool json = false;
  std::string align = "none";
  std::string relation = "trans";
  std::string unit = "frames";
  EvaluateSettings settings;
};

const std::map<std::string, AlignmentKind> kAlignments{{"none", AlignmentKind::none},
                                                       {"se2", AlignmentKind::se2},
                                                       {"se3", AlignmentKind::se3},
                                                       {"sim3", AlignmentKind::sim3},
                                                       {"origin", AlignmentKind::origin}};
const std::map<std::string, PoseRelation> kRelations{{"trans", PoseRelation::translation},
                                                     {"rot", PoseRelation::rotation_deg},
                                                     {"full", PoseRelation::full}};
const std::map<std::string, DeltaUnit> kUnits{{"frames", DeltaUnit::frames},
                                              {"m", DeltaUnit::metres},
                                              {"deg", DeltaUnit::degrees},
                                              {"rad", DeltaUnit::radians}};

template <typename Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) { names.push_back(name); }
  return names;
}

void resolve_names(Options& options) {
  options.settings.alignment = kAlignments.at(options.align);
  options.settings.relation = kRelations.at(options.relation);
  options.settings.delta.unit = kUnits.at(options.unit);
}

const char* unit_of(PoseRelation relation) {
  return relation == PoseRelation::translation ? "m" : relation == PoseRelation::full ? "-" : "deg";
}

host::Json json_of(const EvaluateResult& result) {
  const ErrorStatistics& s = result.statistics;
  return {{"rmse", s.rmse}, {"mean", s.mean},   {"median", s.median},
          {"std", s.std},   {"min", s.min},     {"max", s.max},
          {"sse", s.sse},   {"pairs", s.count}, {"scale", result.alignment.scale}};
}

/// Blue for small, red for large errors, in nine classes.
std::vector<host::PicturePoints> coloured_by_error(const EvaluateResult& result, const char* unit) {
  constexpr std::size_t kClasses = 9;
  std::vector<host::PicturePoints> classes(kClasses);
  const double largest = std::max(result.statistics.max, 1e-12);
  for (std::size_t k = 0; k < kClasses; ++k) {
    const auto share = static_cast<double>(k) / static_cast<double>(kClasses - 1);
    const auto mix = [share](double low, double high) {
      return static_cast<std::uint8_t>(std::lround(low + share * (high - low)));
    };
    classes[k].colour = {mix(33, 214), mix(102, 39), mix(214, 40)};
    classes[k].radius_px = 3.0;
    if (k % 4 == 0) { classes[k].label = fmt::format("{:.3g} {}", share * largest, unit); }
  }
  for (std::size_t i = 0; i < result.errors.size(); ++i) {
    const double share = result.errors[i] / largest * static_cast<double>(kClasses);
    const auto k = std::min(static_cast<std::size_t>(std::max(share, 0.0)), kClasses - 1);
    classes[k].points_m.push_back({result.at[i].translation_m.x, result.at[i].translation_m.y});
  }
  return classes;
}

host::PictureLine line_of(const std::vector<Transform3d>& poses, host::Colour colour,
                          double width_px, const std::string& label) {
  host::PictureLine line{{}, colour, width_px, label};
  for (const Transform3d& pose : poses) {
    line.points_m.push_back({pose.translation_m.x, pose.translation_m.y});
  }
  return line;
}

void draw(const std::string& title, const Options& options, const PosePairs& pairs,
          const EvaluateResult& result) {
  const char* unit = unit_of(options.settings.relation);
  const std::string note =
      fmt::format("rmse {:.4g} {}, median {:.4g}, max {:.4g}, {} pairs", result.statistics.rmse,
                  unit, result.statistics.median, result.statistics.max, result.statistics.count);
  host::make_folder(options.out);

  host::Picture map;
  map.title = title + " along the way";
  map.note = note;
  map.lines.push_back(line_of(pairs.reference, host::palette::kTruth, 2.0, "reference"));
  map.points = coloured_by_error(result, unit);
  write_picture(map, options.out, "error_map");

  const std::string x_label = pairs.stamped ? "time [s]" : "pose number";
  const double start = pairs.stamped ? pairs.stamps_s.front() : 0.0;
  const auto since = [start](std::vector<double> stamps) {
    for (double& stamp : stamps) { stamp -= start; }
    return stamps;
  };
  host::Chart errors{title, note, x_label, {{fmt::format("error [{}]", unit), {}}}};
  errors.panels[0].curves.push_back(
      {since(result.stamps_s), result.errors, host::palette::kOdometry, 1.5, "error"});
  write_chart(errors, options.out, "error");

  host::Chart axes{title + ": position", note, x_label, {}};
  const double Vector3d::*members[] = {&Vector3d::x, &Vector3d::y, &Vector3d::z};
  const char* labels[] = {"x [m]", "y [m]", "z [m]"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto along = [&](const std::vector<Transform3d>& poses) {
      std::vector<double> values;
      for (const Transform3d& pose : poses) { values.push_back(pose.translation_m.*members[axis]); }
      return values;
    };
    const std::vector<double> x = since(pairs.stamps_s);
    axes.panels.push_back({labels[axis],
                           {{x, along(pairs.reference), host::palette::kTruth, 3.0, "reference"},
                            {x, along(pairs.estimate), host::palette::kPicolo, 1.5, "estimate"}}});
  }
  write_chart(axes, options.out, "position");
}

void print_text(const std::string& title, const EvaluateResult& result, const char* unit) {
  const ErrorStatistics& s = result.statistics;
  fmt::print("{} of {} pairs [{}]\n", title, s.count, unit);
  for (const auto& [name, value] : {std::pair{"rmse", s.rmse},
                                    {"mean", s.mean},
                                    {"median", s.median},
                                    {"std", s.std},
                                    {"min", s.min},
                                    {"max", s.max},
                                    {"sse", s.sse}}) {
    fmt::print("  {:<7} {:.9g}\n", name, value);
  }
}

struct Loaded {
  host::SpatialTrajectory reference;
  host::SpatialTrajectory estimate;
};

Loaded load(const Options& options) {
  if (options.reference == "-" && options.estimate == "-") {
    throw host::UserError{ExitCode::usage, "-", "both trajectories are standard input",
                          "give one of them as a file"};
  }
  host::Diagnostics diagnostics;
  host::LineReader reference{options.reference};
  host::LineReader estimate{options.estimate};
  return {read_spatial_trajectory(reference, diagnostics),
          read_spatial_trajectory(estimate, diagnostics)};
}

ExitCode end(const Loaded& loaded) {
  const ExitCode reference = end_of_input(loaded.reference.name, loaded.reference.damage);
  const ExitCode estimate = end_of_input(loaded.estimate.name, loaded.estimate.damage);
  return reference != ExitCode::done ? reference : estimate;
}

ExitCode evaluate(const Options& options, bool relative) {
  const Loaded loaded = load(options);
  PosePairs pairs = paired(loaded.reference, loaded.estimate, options.settings);
  const EvaluateResult result = relative
                                    ? evaluate_rpe(pairs, options.settings, loaded.estimate.name)
                                    : evaluate_ape(pairs, options.settings, loaded.estimate.name);
  const std::string title = relative ? "Relative pose error" : "Absolute pose error";
  if (!options.out.empty()) { draw(title, options, pairs, result); }
  if (options.json) {
    fmt::print("{}\n", host::to_text(json_of(result)));
  } else {
    print_text(title, result, unit_of(options.settings.relation));
  }
  return end(loaded);
}

ExitCode evaluate_kitti(const Options& options) {
  const Loaded loaded = load(options);
  const PosePairs pairs = paired(loaded.reference, loaded.estimate, options.settings);
  const SegmentReport report = evaluate_segments(pairs, loaded.estimate.name);
  constexpr double kDegrees = 57.29577951308232;
  if (options.json) {
    host::Json lengths = host::Json::array();
    for (std::size_t k = 0; k < kSegmentLengths; ++k) {
      const SegmentDrift& drift = report.by_length[k];
      if (drift.count == 0) { continue; }
      lengths.push_back({{"length_m", SegmentConfig{}.lengths_m[k]},
                         {"translation_percent", 100.0 * drift.translation_share},
                         {"rotation_deg_per_m", kDegrees * drift.rotation_rad_per_m},
                         {"segments", drift.count}});
    }
    fmt::print("{}\n",
               host::to_text({{"translation_percent", 100.0 * report.overall.translation_share},
                              {"rotation_deg_per_m", kDegrees * report.overall.rotation_rad_per_m},
                              {"segments", report.overall.count},
                              {"by_length", lengths}}));
    return end(loaded);
  }
  fmt::print("KITTI odometry error over {} stretches: {:.4f} %, {:.6f} deg/m\n",
             report.overall.count, 100.0 * report.overall.translation_share,
             kDegrees * report.overall.rotation_rad_per_m);
  for (std::size_t k = 0; k < kSegmentLengths; ++k) {
    const SegmentDrift& drift = report.by_length[k];
    if (drift.count == 0) { continue; }
    fmt::print("  {:>4.0f} m  {:.4f} %  {:.6f} deg/m  ({} stretches)\n",
               SegmentConfig{}.lengths_m[k], 100.0 * drift.translation_share,
               kDegrees * drift.rotation_rad_per_m, drift.count);
  }
  return end(loaded);
}

void add_files(CLI::App& command, Options& options) {
  command.add_option("REF", options.reference, "Reference: TUM, KITTI or EuRoC; .gz, - for a pipe")
      ->required();
  command.add_option("EST", options.estimate, "Estimate: likewise")->required();
  command
      .add_option("--max-diff", options.settings.max_difference_s,
                  "Poses belong together when their stamps differ by at most this")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  command.add_option("--offset", options.settings.offset_s, "Added to the estimate's stamps")
      ->type_name("S");
  command.add_flag("--interpolate", options.settings.interpolate,
                   "Compare with the reference interpolated at the estimate's stamps");
  command.add_flag("--json", options.json,
                   "Print one JSON object on standard output (SI units, plain decimals)");
}

void add_metric(CLI::App& command, Options& options) {
  command
      .add_option("--align", options.align,
                  "none, origin (first poses), se2 (yaw, x, y), se3, or sim3 (with scale)")
      ->check(CLI::IsMember(names_of(kAlignments)))
      ->capture_default_str()
      ->type_name("KIND");
  command
      .add_option("--relation", options.relation, "trans [m], rot [deg], or full (norm of E - I)")
      ->check(CLI::IsMember(names_of(kRelations)))
      ->capture_default_str()
      ->type_name("WHAT");
  command.add_option("--out", options.out, "Folder for pictures: error, error_map, position")
      ->type_name("DIR");
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("evaluate", "Compares a trajectory with a reference, as evo does");
  command->require_subcommand(1);

  auto ape = std::make_shared<Options>();
  CLI::App* absolute = command->add_subcommand("ape", "Absolute pose error");
  add_files(*absolute, *ape);
  add_metric(*absolute, *ape);
  absolute->callback([&action, ape] {
    resolve_names(*ape);
    action = [ape] { return evaluate(*ape, false); };
  });

  auto rpe = std::make_shared<Options>();
  CLI::App* relative = command->add_subcommand("rpe", "Relative pose error over a delta");
  add_files(*relative, *rpe);
  add_metric(*relative, *rpe);
  relative->add_option("--delta", rpe->settings.delta.delta, "How far apart the poses are")
      ->type_name("D");
  relative->add_option("--unit", rpe->unit, "Of --delta: frames, m, deg or rad")
      ->check(CLI::IsMember(names_of(kUnits)))
      ->capture_default_str()
      ->type_name("UNIT");
  relative->add_flag("--all-pairs", rpe->settings.delta.all_pairs,
                     "All pairs that far apart, not only consecutive ones");
  relative->callback([&action, rpe] {
    resolve_names(*rpe);
    action = [rpe] { return evaluate(*rpe, true); };
  });

  auto kitti = std::make_shared<Options>();
  CLI::App* segments =
      command->add_subcommand("kitti", "Drift over stretches of 100 to 800 m, as KITTI scores it");
  add_files(*segments, *kitti);
  segments->callback([&action, kitti] { action = [kitti] { return evaluate_kitti(*kitti); }; });

  command->footer(
      "Same formulas and figures as evo (APE, RPE, Umeyama alignment), to nine digits.\n"
      "\n"
      "Examples:\n"
      "  picolo evaluate ape groundtruth.tum estimate.tum --align se3\n"
      "  picolo evaluate rpe gt.txt.gz est.txt.gz --delta 10 --unit m --all-pairs --relation rot\n"
      "  zcat est.gz | picolo evaluate ape gt.txt - --align se2 --json --out pictures");
}

}  // namespace picolo::tool
