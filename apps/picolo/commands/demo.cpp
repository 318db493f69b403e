// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "commands/demo_drive.hpp"
#include "drive_result.hpp"
#include "picolo/host/ape.hpp"
#include "picolo/host/config_file.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/picture.hpp"
#include "picolo/host/progress.hpp"

namespace picolo::tool {
namespace {

constexpr int kMaxSeconds = 3600;

struct Options {
  CommonOptions common;
  std::optional<int> seconds;
  std::optional<int> seed;
  std::string record;
};

DemoSettings settings_from(const Options& options) {
  DemoSettings settings;
  int seed = static_cast<int>(settings.seed);
  host::ConfigFile file{options.common.config};
  file.read("demo", "seconds", settings.seconds);
  file.read("demo", "seed", seed);
  file.reject_unknown({"localiser", "replay", "undistort"});
  settings.record = options.record;
  settings.seconds = options.seconds.value_or(settings.seconds);
  settings.seed = static_cast<std::uint64_t>(options.seed.value_or(seed));
  if (settings.seconds < 1 || settings.seconds > kMaxSeconds || options.seed.value_or(seed) < 0) {
    throw host::UserError{ExitCode::usage, options.common.config,
                          "seconds or seed of [demo] is out of its domain",
                          fmt::format("seconds 1 to {}, seed not negative", kMaxSeconds)};
  }
  return settings;
}

void draw(const DemoResult& result, const DemoSettings& settings, const host::ApeSummary& ape,
          const host::ApeSummary& ape_odometry, const std::filesystem::path& folder) {
  host::Picture picture;
  picture.title = "picolo demo: CAN frames and serial bytes to a pose";
  picture.note = fmt::format(
      "simulated drive of {} s, seed {}: error {:.3f} m rmse, odometry {:.2f} m", settings.seconds,
      settings.seed, ape.statistics.rmse, ape_odometry.statistics.rmse);
  picture.maps.push_back(result.map);
  picture.lines.push_back(trajectory_line(result.truth, host::palette::kTruth, 7.0, "truth"));
  picture.lines.push_back(
      trajectory_line(result.odometry, host::palette::kOdometry, 2.0, "odometry: wheels and gyro"));
  picture.lines.push_back(
      trajectory_line(result.trajectory, host::palette::kPicolo, 2.0, "picolo"));
  write_picture(picture, folder, "picture");
}

host::Json tasks_json(const DemoResult& result) {
  host::Json tasks = host::Json::array();
  for (const TaskTime& task : result.tasks) {
    tasks.push_back(
        {{"name", task.name}, {"median_us", task.median_us}, {"worst_us", task.worst_us}});
  }
  return tasks;
}

/// Not measured while recording.
host::Json heap_calls_json(const DemoResult& result, const DemoSettings& settings) {
  return settings.record.empty() ? host::Json(result.heap_calls) : host::Json(nullptr);
}

void report(const DemoResult& result, const DemoSettings& settings, const host::ApeSummary& ape,
            const host::ApeSummary& ape_odometry, const Options& options) {
  if (options.common.json) {
    fmt::print("{}\n", host::to_text({{"seconds", settings.seconds},
                                      {"seed", settings.seed},
                                      {"scans", result.counters.sweeps},
                                      {"matched", result.counters.matched},
                                      {"outcomes", outcomes_json(result.counters)},
                                      {"heap_calls", heap_calls_json(result, settings)},
                                      {"ape", to_json(ape)},
                                      {"ape_odometry", to_json(ape_odometry)},
                                      {"state", to_string(result.state)},
                                      {"tracking_share", result.tracking_share},
                                      {"tasks", tasks_json(result)}}));
    return;
  }
  fmt::print(
      "{} s, {} scans, {} matched; {} at the end, tracking {:.1f} % of the time\n"
      "error {:.3f} m rmse ({:.3f} m at most), odometry of wheels and gyro {:.3f} m\n"
      "{} heap calls in the cycle\n",
      settings.seconds, result.counters.sweeps, result.counters.matched, to_string(result.state),
      100.0 * result.tracking_share, ape.statistics.rmse, ape.statistics.max,
      ape_odometry.statistics.rmse, result.heap_calls);
  for (const TaskTime& task : result.tasks) {
    fmt::print("  {:<10} {:>7.1f} us median {:>8.1f} us worst\n", task.name, task.median_us,
               task.worst_us);
  }
  fmt::print("picture: {}\n", (std::filesystem::path{options.common.out} / "picture.png").string());
}

ExitCode demo(const Options& options) {
  const DemoSettings settings = settings_from(options);
  const std::filesystem::path folder{options.common.out};
  host::make_folder(folder);
  DemoResult result;
  {
    host::Progress progress{"driving", static_cast<std::size_t>(settings.seconds)};
    result = drive_demo(settings, [&progress](std::size_t seconds) { progress.at(seconds); });
  }
  if (result.trajectory.empty()) {
    throw host::UserError{
        ExitCode::refused, "demo",
        fmt::format("no pose in {} s: {}", settings.seconds, to_string(result.reason)),
        "the first match takes about half a second; give it more with --seconds"};
  }
  write_tum(folder / "trajectory.tum", result.trajectory);
  write_tum(folder / "odometry.tum", result.odometry);
  write_tum(folder / "truth.tum", result.truth);
  write_map(folder, "map", result.map);
  const host::ApeSummary ape = host::evaluate_ape(result.truth, result.trajectory);
  const host::ApeSummary ape_odometry = host::evaluate_ape(result.truth, result.odometry);
  draw(result, settings, ape, ape_odometry, folder);
  report(result, settings, ape, ape_odometry, options);
  return result.heap_calls == 0 ? ExitCode::done : ExitCode::refused;
}

}  // namespace

void add_demo(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("demo", "Drives a simulated vehicle through the whole chain");
  add_common_options(*command, options->common);
  command->add_option("--seconds", options->seconds, "Length of the drive in simulated time [240]")
      ->check(CLI::Range(1, kMaxSeconds))
      ->type_name("N");
  command
      ->add_option("--seed", options->seed,
                   "Noise, slip and biases; the same seed, the same drive [1]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  command->add_option("--record", options->record, "Write everything that arrives to this folder")
      ->type_name("DIR");
  command->footer(
      "A vehicle with imperfect wheels drives through an office. Its wheel encoders speak "
      "CANopen,\n"
      "its lidar and gyro send their true bytes over serial lines; drivers, cyclic executive and\n"
      "localisation are those that run in firmware. Time is virtual: the drive repeats bit for "
      "bit.\n"
      "\n"
      "Examples:\n"
      "  picolo demo\n"
      "      writes picture.png and .svg (map, truth grey, odometry red, picolo green),\n"
      "      trajectory.tum, odometry.tum, truth.tum, map.pgm and map.yaml to ./picolo-out\n"
      "  picolo demo --seconds 60 --seed 7 --json --out /tmp/demo\n"
      "\n"
      "Settings in --config FILE: [demo] seconds seed");
  command->callback([&action, options] { action = [options] { return demo(*options); }; });
}

}  // namespace picolo::tool
