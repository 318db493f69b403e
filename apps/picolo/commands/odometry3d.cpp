// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "commands/evaluate_metrics.hpp"
#include "picolo/heap_trap/heap_trap.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/lidar_scans3.hpp"
#include "picolo/host/picture.hpp"
#include "picolo/host/progress.hpp"
#include "picolo/odometry/loam_odometry.hpp"

namespace picolo::tool {
namespace {

using Odometry16 = LoamOdometry<>;
/// For folders of scans of bigger lidars; a host has the memory.
using Odometry64 = LoamOdometry<64, 4096, 3072, 9216, 4096, 6, 20480, 8>;

constexpr double kKittiElevation_deg = 0.205;
constexpr std::size_t kMapEvery = 4;  ///< scans whose points are drawn

struct Options {
  std::string input;
  std::string out = "picolo-out";
  std::string reference;
  std::optional<double> elevation_deg;
  host::RingModel rings;
  bool json = false;
};

struct Run {
  host::SpatialTrajectory trajectory;
  std::vector<double> scan_ms;  ///< processor time of one scan, sorted after the run
  double slice_ms = 0.0;        ///< the longest call of all
  std::uint64_t heap_calls = 0;
  std::size_t memory_bytes = 0;
  std::size_t map_bytes = 0;
  LoamReport last{};
  std::vector<Point2<double>> map_m;
};

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

void process(LoamCore& core, const host::RingScan& scan, Run& run) {
  const heap_trap::Guard guard;
  const double start_ms = thread_ms();
  double slice_start_ms = start_ms;
  const auto end_of_slice = [&] {
    const double now_ms = thread_ms();
    run.slice_ms = std::max(run.slice_ms, now_ms - slice_start_ms);
    slice_start_ms = now_ms;
  };
  core.begin_scan();
  for (std::size_t ring = 0; ring < scan.rings.size(); ++ring) {
    (void)core.add_ring(ring, scan.rings[ring]);  // counted in the report when refused
    end_of_slice();
  }
  for (bool done = false; !done;) {
    done = core.step();
    end_of_slice();
  }
  run.scan_ms[core.report().scans - 1] = slice_start_ms - start_ms;
}

void collect_map(const LoamCore& core, const Pose3d& map_T_lidar, Run& run) {
  const auto collect = [&](std::span<const Feature> features) {
    for (const Feature& feature : features) {
      const Vector3d p = transform(map_T_lidar, to_f64(feature.point_m));
      const double height_m = p.z - map_T_lidar.translation_m.z;
      if (height_m > -1.2 && height_m < 3.0) { run.map_m.push_back({p.x, p.y}); }  // no ground
    }
  };
  collect(core.edges());
  collect(core.surfaces());
}

template <typename Odometry>
Run run_with(host::ScanReader& reader, double elevation_rad) {
  LoamConfig config;
  config.compensated = true;
  const auto odometry = std::make_unique<Odometry>(config);
  Run run;
  run.memory_bytes = Odometry::memory_bytes();
  run.map_bytes = Odometry::map_bytes();
  run.scan_ms.resize(reader.scans());
  run.trajectory.name = reader.name();
  host::Progress progress{"scans", reader.scans()};
  host::RingScan scan;
  LoamCore& core = odometry->core();
  const std::uint64_t heap_before = heap_trap::calls();
  while (reader.next(scan)) {
    if (elevation_rad != 0.0) { correct_elevation(scan, elevation_rad); }
    process(core, scan, run);
    const Pose3d& pose = core.report().map_T_lidar;
    if (run.trajectory.poses.size() % kMapEvery == 0) { collect_map(core, pose, run); }
    run.trajectory.stamps_s.push_back(scan.stamp_s);
    run.trajectory.poses.push_back(to_transform(pose));
    progress.at(run.trajectory.poses.size());
  }
  run.heap_calls = heap_trap::calls() - heap_before;
  run.last = core.report();
  run.scan_ms.resize(run.trajectory.poses.size());
  std::sort(run.scan_ms.begin(), run.scan_ms.end());
  if (run.trajectory.poses.empty()) {
    throw host::UserError{ExitCode::input, reader.name(), "holds no whole scan",
                          "get a whole copy"};
  }
  return run;
}

struct Score {
  ErrorStatistics ape{};
  ErrorStatistics ape_aligned{};
  ErrorStatistics rpe_m{};
  ErrorStatistics rpe_deg{};
};

Score score_of(const Run& run, const host::SpatialTrajectory& reference) {
  host::SpatialTrajectory estimate = run.trajectory;
  host::SpatialTrajectory truth = reference;
  if (truth.stamps_s.empty()) { estimate.stamps_s.clear(); }
  const auto with = [&](AlignmentKind kind, PoseRelation relation, bool relative) {
    EvaluateSettings settings{.alignment = kind, .relation = relation};
    settings.delta = {.delta = 10.0, .unit = DeltaUnit::frames, .all_pairs = true};
    PosePairs pairs = paired(truth, estimate, settings);
    return (relative ? evaluate_rpe(pairs, settings, estimate.name)
                     : evaluate_ape(pairs, settings, estimate.name))
        .statistics;
  };
  return {with(AlignmentKind::none, PoseRelation::translation, false),
          with(AlignmentKind::se3, PoseRelation::translation, false),
          with(AlignmentKind::none, PoseRelation::translation, true),
          with(AlignmentKind::none, PoseRelation::rotation_deg, true)};
}

double way_m(const Run& run) {
  std::vector<double> path_m(run.trajectory.poses.size());
  (void)accumulate_path(run.trajectory.poses, path_m);
  return path_m.back();
}

host::PictureLine line_of(const std::vector<Transform3d>& poses, host::Colour colour,
                          double width_px, const std::string& label) {
  host::PictureLine line{{}, colour, width_px, label};
  for (const Transform3d& pose : poses) {
    line.points_m.push_back({pose.translation_m.x, pose.translation_m.y});
  }
  return line;
}

void draw(const Run& run, const std::optional<host::SpatialTrajectory>& reference,
          const std::optional<Score>& score, const Options& options) {
  host::Picture picture;
  picture.title = "3D odometry and its map from above";
  picture.note = fmt::format("{} scans, {:.1f} m", run.trajectory.poses.size(), way_m(run));
  if (score) {
    picture.note +=
        fmt::format(", APE rmse {:.3f} m ({:.3f} m aligned), RPE over 10 scans {:.3f} m",
                    score->ape.rmse, score->ape_aligned.rmse, score->rpe_m.rmse);
  }
  picture.points.push_back({run.map_m, {70, 76, 92, 150}, 1.0, "edges and surfaces"});
  if (reference) {
    picture.lines.push_back(line_of(reference->poses, host::palette::kOdometry, 4.0, "reference"));
  }
  picture.lines.push_back(
      line_of(run.trajectory.poses, host::palette::kPicolo, 2.0, "picolo odometry3d"));
  write_picture(picture, options.out, "odometry3d");
}

void report(const Run& run, const std::optional<Score>& score, const Options& options) {
  const auto quantile_ms = [&](double share) {
    const auto last = static_cast<double>(run.scan_ms.size() - 1);
    return run.scan_ms[static_cast<std::size_t>(std::lround(share * last))];
  };
  double total_ms = 0.0;
  for (const double ms : run.scan_ms) { total_ms += ms; }
  const double mean_ms = total_ms / static_cast<double>(run.scan_ms.size());
  if (options.json) {
    host::Json json{{"scans", run.trajectory.poses.size()},
                    {"way_m", way_m(run)},
                    {"scan_ms_mean", mean_ms},
                    {"scan_ms_median", quantile_ms(0.5)},
                    {"scan_ms_p99", quantile_ms(0.99)},
                    {"scan_ms_max", quantile_ms(1.0)},
                    {"slice_ms_max", run.slice_ms},
                    {"heap_calls", run.heap_calls},
                    {"memory_bytes", run.memory_bytes},
                    {"map_bytes", run.map_bytes},
                    {"dropped_features", run.last.dropped_features},
                    {"skipped_rings", run.last.skipped_rings}};
    if (score) {
      json["ape_m"] = score->ape.rmse;
      json["ape_se3_m"] = score->ape_aligned.rmse;
      json["rpe10_m"] = score->rpe_m.rmse;
      json["rpe10_deg"] = score->rpe_deg.rmse;
    }
    fmt::print("{}\n", host::to_text(json));
    return;
  }
  fmt::print(
      "{} scans, {:.1f} m\n"
      "time a scan: mean {:.2f} ms, median {:.2f}, 99 % {:.2f}, longest {:.2f}; longest slice "
      "{:.2f} ms\n"
      "memory: {:.0f} KiB, {:.0f} KiB of it map; heap calls in scans: {}\n",
      run.trajectory.poses.size(), way_m(run), mean_ms, quantile_ms(0.5), quantile_ms(0.99),
      quantile_ms(1.0), run.slice_ms, static_cast<double>(run.memory_bytes) / 1024.0,
      static_cast<double>(run.map_bytes) / 1024.0, run.heap_calls);
  if (score) {
    fmt::print(
        "against the reference: APE rmse {:.4f} m ({:.4f} m after SE(3) alignment), RPE over 10 "
        "scans {:.4f} m, {:.4f} deg\n",
        score->ape.rmse, score->ape_aligned.rmse, score->rpe_m.rmse, score->rpe_deg.rmse);
  }
  fmt::print("written to {}: trajectory.tum, trajectory.kitti, odometry3d.png, .svg\n",
             options.out);
}

ExitCode odometry3d(const Options& options) {
  host::ScanReader reader{options.input, options.rings};
  std::optional<host::SpatialTrajectory> reference;
  if (!options.reference.empty()) {
    host::Diagnostics diagnostics;
    host::LineReader lines{options.reference};
    reference = read_spatial_trajectory(lines, diagnostics);
  }
  host::make_folder(options.out);
  const double elevation_rad =
      options.elevation_deg.value_or(reader.is_kitti() ? kKittiElevation_deg : 0.0) *
      std::numbers::pi / 180.0;
  const Run run = reader.rings() <= 16 ? run_with<Odometry16>(reader, elevation_rad)
                                       : run_with<Odometry64>(reader, elevation_rad);
  const std::filesystem::path folder{options.out};
  write_spatial_trajectory(folder / "trajectory.tum", run.trajectory, host::TrajectoryFormat::tum);
  write_spatial_trajectory(folder / "trajectory.kitti", run.trajectory,
                           host::TrajectoryFormat::kitti);
  std::optional<Score> score;
  if (reference) { score = score_of(run, *reference); }
  draw(run, reference, score, options);
  report(run, score, options);
  return end_of_input(reader.name(), reader.damage());
}

}  // namespace

void add_odometry3d(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "odometry3d", "The way of a spinning 3D lidar from lines and planes (LOAM)");
  command
      ->add_option("SCANS", options->input,
                   "A .l3d log (plain or .gz), or a folder of KITTI .bin or of .ply scans")
      ->required();
  command->add_option("--out", options->out, "Folder for the files that are written")
      ->capture_default_str()
      ->type_name("DIR");
  command->add_option("--reference", options->reference, "Trajectory to compare with")
      ->type_name("FILE");
  command
      ->add_option("--elevation-correction", options->elevation_deg,
                   "Turns every return up by this; default 0.205 for .l3d and .bin (KITTI's lidar)")
      ->type_name("DEG");
  command->add_option("--rings", options->rings.rings, "Rings of the lidar, for folders of scans")
      ->check(CLI::Range(4, 64))
      ->capture_default_str();
  command->add_option("--lowest", options->rings.lowest_deg, "Elevation of the lowest ring")
      ->capture_default_str()
      ->type_name("DEG");
  command->add_option("--highest", options->rings.highest_deg, "Elevation of the highest ring")
      ->capture_default_str()
      ->type_name("DEG");
  command->add_flag("--json", options->json,
                    "Print one JSON object on standard output (SI units, plain decimals)");
  command->footer(
      "Edges and surfaces of each scan are matched with the last scan and with a rolling map of\n"
      "fixed size; nothing is allocated while a scan is worked on. Scans are taken as motion\n"
      "compensated.\n"
      "\n"
      "Examples:\n"
      "  picolo odometry3d drive.l3d.gz --out out --reference truth.kitti\n"
      "      writes trajectory.tum, trajectory.kitti and odometry3d.png to ./out\n"
      "  picolo odometry3d velodyne_points/data --json");
  command->callback([&action, options] { action = [options] { return odometry3d(*options); }; });
}

}  // namespace picolo::tool
