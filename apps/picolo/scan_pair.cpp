// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "scan_pair.hpp"

#include <fmt/format.h>

#include "matcher_replay.hpp"
#include "picolo/host/error.hpp"
#include "processor_time.hpp"

namespace picolo::tool {

void ChosenScan::keep(const UndistortedSweep& from) {
  x_m.assign(from.points.x_m.begin(), from.points.x_m.end());
  y_m.assign(from.points.y_m.begin(), from.points.y_m.end());
  sweep = from;
  sweep.points = {};
  sweep.points.x_m = x_m;
  sweep.points.y_m = y_m;
}

std::map<std::size_t, ChosenScan> read_scans(const std::string& log,
                                             const std::set<std::size_t>& numbers,
                                             const ReplaySettings& settings,
                                             host::Diagnostics& diagnostics) {
  host::LineReader reader{log};
  const ReplayInput input = prepare(read_carmen(reader, diagnostics), settings, diagnostics);
  const auto points = std::make_unique<ScanPoints>(input);
  std::map<std::size_t, ChosenScan> chosen;
  std::size_t next = 0;
  for (const std::size_t number : numbers) {
    if (number >= input.scans.size()) {
      throw host::UserError{host::ExitCode::usage, log, fmt::format("has no scan {}", number),
                            fmt::format("its scans are 0 to {}", input.scans.size() - 1)};
    }
    const UndistortedSweep* sweep = nullptr;
    for (; next <= number; ++next) { sweep = points->of(input.scans[next]); }
    if (sweep == nullptr) {
      throw host::UserError{
          host::ExitCode::refused, log,
          fmt::format("line {}: odometry does not cover the scan", input.scans[number].line),
          "choose a later one"};
    }
    chosen[number].keep(*sweep);
    chosen[number].has_odometry = input.use_odometry;
  }
  return chosen;
}

namespace {

MapConfig half_cells(const MapConfig& map) {
  MapConfig halved = map;
  halved.cell_m *= 0.5F;
  return halved;
}

}  // namespace

PairMatcher::PairMatcher(MatcherKind kind)
    : kind_{kind},
      map_{std::make_unique<ScanMap>(fine_map_config<SiteProfile>(config_.map))},
      sharp_map_{std::make_unique<ScanMap>(half_cells(map_->core().config()))} {}

PairMatch PairMatcher::match(const ChosenScan& reference, const ChosenScan& scan,
                             const Pose2d& guess) {
  const auto matcher = make_scan_matcher(kind_, config_, map_->core());
  const auto refiner = make_scan_matcher(MatcherKind::gn, config_, sharp_map_->core());
  for (ScanMap* map : {map_.get(), sharp_map_.get()}) {
    map->core().reset(0.0, 0.0);
    insert_scan(map->core(), reference.sweep, {}, config_);
  }
  matcher->follow({});
  matcher->add(reference.sweep, {});
  // A guess is a guess: it shall not hold the answer.
  constexpr GuessSigma kHardlyAnything{.translation_m = 10.0F, .rotation_rad = 10.0F};
  const double begin_us = processor_time_us();
  PairMatch result{.guess = guess, .match = matcher->match(scan.sweep, guess, kHardlyAnything)};
  const bool on_field = kind_ != MatcherKind::ndt && kind_ != MatcherKind::plicp;
  if (on_field && is_pose(result.match.report.outcome)) {
    const ScanMatch sharper = refiner->match(scan.sweep, result.match.map_T_base, kHardlyAnything);
    if (is_pose(sharper.report.outcome)) { result.match = sharper; }
  }
  result.time_us = processor_time_us() - begin_us;
  return result;
}

}  // namespace picolo::tool
