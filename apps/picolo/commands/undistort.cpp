// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "commands/undistort_sweeps.hpp"
#include "picolo/host/config_file.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/picture.hpp"

namespace picolo::tool {
namespace {

struct Options {
  CommonOptions common;
  std::string sweeps;
  std::vector<double> lidar;
  std::optional<double> cell_m;
  std::optional<double> min_yaw_rate_radps;
};

UndistortSettings settings_from(const Options& options) {
  UndistortSettings settings;
  host::ConfigFile file{options.common.config};
  file.read("undistort", "lidar_x_m", settings.base_T_lidar.x_m);
  file.read("undistort", "lidar_y_m", settings.base_T_lidar.y_m);
  file.read("undistort", "lidar_yaw_rad", settings.base_T_lidar.theta_rad);
  file.read("undistort", "cell_m", settings.cell_m);
  file.read("undistort", "min_yaw_rate_radps", settings.min_yaw_rate_radps);
  file.read("undistort", "max_range_m", settings.max_range_m);
  file.reject_unknown({"localiser", "replay", "demo"});
  if (options.lidar.size() == 3) {
    settings.base_T_lidar = {options.lidar[0], options.lidar[1], options.lidar[2]};
  }
  settings.cell_m = options.cell_m.value_or(settings.cell_m);
  settings.min_yaw_rate_radps = options.min_yaw_rate_radps.value_or(settings.min_yaw_rate_radps);
  if (!settings.valid()) {
    throw host::UserError{ExitCode::usage, options.common.config,
                          "cell size, yaw rate or range limit is out of its domain",
                          "cell and range must be positive, the yaw rate not negative"};
  }
  return settings;
}

std::vector<Point2<double>> centres(const Cells& cells, double cell_m) {
  std::vector<Point2<double>> points_m;
  for (const auto& [column, row] : cells) {
    points_m.push_back(
        {(static_cast<double>(column) + 0.5) * cell_m, (static_cast<double>(row) + 0.5) * cell_m});
  }
  return points_m;
}

void draw(const UndistortResult& result, const UndistortSettings& settings,
          const std::filesystem::path& folder) {
  const auto before_m = centres(result.before, settings.cell_m);
  const auto after_m = centres(result.after, settings.cell_m);
  const auto picture = [&](const std::string& title, const auto& points_m) {
    host::Picture drawing;
    drawing.title = title;
    drawing.note = fmt::format("{} sweeps, {} returns, {} cells of {:g} m in the odometry frame",
                               result.sweeps_counted, result.returns_counted, points_m.size(),
                               settings.cell_m);
    drawing.points.push_back({points_m, host::palette::kInk, 1.5, "cells with a return"});
    drawing.lines.push_back(
        host::trajectory_line(result.odometry, host::palette::kOdometry, 2.0, "wheel odometry"));
    drawing.keep_in_view_m = before_m;
    drawing.keep_in_view_m.insert(drawing.keep_in_view_m.end(), after_m.begin(), after_m.end());
    return drawing;
  };
  write_picture(picture("Before: every sweep taken as one instant", before_m), folder, "before");
  write_picture(picture("After: every return at its own time", after_m), folder, "after");
}

void report(const UndistortResult& result, bool json, const std::filesystem::path& folder) {
  const double ratio =
      static_cast<double>(result.after.size()) / static_cast<double>(result.before.size());
  if (json) {
    fmt::print("{}\n", host::to_text({{"sweeps_counted", result.sweeps_counted},
                                      {"sweeps_slow", result.sweeps_slow},
                                      {"sweeps_uncovered", result.sweeps_uncovered},
                                      {"returns_counted", result.returns_counted},
                                      {"cells_before", result.before.size()},
                                      {"cells_after", result.after.size()},
                                      {"cells_ratio", ratio}}));
    return;
  }
  fmt::print(
      "{} sweeps with {} returns ({} turned too slowly, {} not covered by odometry)\n"
      "{} cells before, {} after: {:.3f}\n"
      "pictures: {}, {}\n",
      result.sweeps_counted, result.returns_counted, result.sweeps_slow, result.sweeps_uncovered,
      result.before.size(), result.after.size(), ratio, (folder / "before.png").string(),
      (folder / "after.png").string());
}

ExitCode undistort(const Options& options) {
  const UndistortSettings settings = settings_from(options);
  host::Diagnostics diagnostics;
  host::LineReader reader{options.sweeps};
  const host::CarmenLog log = read_carmen(reader, diagnostics);
  if (log.sweeps.empty() || log.odometry.empty()) {
    throw host::UserError{
        ExitCode::input, log.name,
        fmt::format("holds {} valid SWEEP and {} valid ODOM records{}", log.sweeps.size(),
                    log.odometry.size(), log.damage.empty() ? "" : ", and " + log.damage),
        "undistortion needs both; a CARMEN log without beam times goes to 'picolo replay'"};
  }
  const UndistortResult result = undistort_sweeps(log, settings);
  if (result.returns_counted == 0) {
    throw host::UserError{
        ExitCode::refused, log.name,
        fmt::format("no sweep could be counted: {} turned slower than {:g} rad/s, {} not covered "
                    "by odometry",
                    result.sweeps_slow, settings.min_yaw_rate_radps, result.sweeps_uncovered),
        "lower --min-yaw-rate"};
  }
  host::make_folder(options.common.out);
  draw(result, settings, options.common.out);
  report(result, options.common.json, options.common.out);
  return end_of_input(log.name, log.damage);
}

}  // namespace

void add_undistort(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("undistort", "Moves every lidar return to where it was measured");
  command->add_option("SWEEPS", options->sweeps, "Log with SWEEP and ODOM lines; .gz, - for a pipe")
      ->required();
  add_common_options(*command, options->common);
  command->add_option("--lidar", options->lidar, "Pose of the lidar on the vehicle: metres, rad")
      ->expected(3)
      ->type_name("X Y YAW");
  command->add_option("--cell", options->cell_m, "Side of the cells that are counted, metres")
      ->type_name("M");
  command
      ->add_option("--min-yaw-rate", options->min_yaw_rate_radps,
                   "Count only sweeps of a vehicle that turns faster, rad/s")
      ->type_name("W");
  command->footer(
      "While a lidar turns once, the vehicle moves: taken as one instant, a sweep of a turning\n"
      "vehicle smears walls. The command counts the cells of a fine grid that the returns occupy,\n"
      "before and after every return was moved by the odometry at its own time; fewer is sharper.\n"
      "\n"
      "Examples:\n"
      "  picolo undistort undistort_sweeps_a.txt.gz\n"
      "      writes before.png, after.png (and .svg) to ./picolo-out and prints the counts\n"
      "  zcat sweeps.gz | picolo undistort - --json --out /tmp/u --lidar 0.21 0 3.14159265\n"
      "\n"
      "Lines: 'SWEEP t time_increment n t_received (angle range)*n' in the order of measurement\n"
      "and 'ODOM x y theta tv rv accel t host t_received'; others are skipped.\n"
      "Settings in --config FILE: [undistort] lidar_x_m lidar_y_m lidar_yaw_rad cell_m\n"
      "min_yaw_rate_radps max_range_m");
  command->callback([&action, options] { action = [options] { return undistort(*options); }; });
}

}  // namespace picolo::tool
