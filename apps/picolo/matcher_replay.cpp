// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "matcher_replay.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "picolo/heap_trap/heap_trap.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/map_mosaic.hpp"
#include "picolo/host/progress.hpp"
#include "processor_time.hpp"

namespace picolo::tool {
namespace {

/// As the localiser's prediction, without what it has learned.
GuessSigma sigma_of(const Pose2d& motion, bool with_odometry, const PredictionNoise& noise) {
  if (!with_odometry) { return {noise.blind_translation_m, noise.blind_rotation_rad}; }
  const auto way_m = static_cast<float>(std::hypot(motion.x_m, motion.y_m));
  const auto turn_rad = static_cast<float>(std::abs(motion.theta_rad));
  return {std::hypot(noise.translation_base_m, noise.translation_per_m * way_m,
                     noise.translation_per_rad_m * turn_rad),
          std::hypot(noise.rotation_base_rad, noise.rotation_per_m_rad * way_m,
                     noise.rotation_per_rad * turn_rad)};
}

class MatcherReplay {
 public:
  MatcherReplay(const ReplayInput& input, const ReplaySettings& settings, MatcherKind kind)
      : input_{input},
        config_{settings.localiser},
        points_{input},
        map_{fine_map_config<SiteProfile>(settings.localiser.map)},
        matcher_{make_scan_matcher(kind, settings.localiser, map_.core())} {}

  DriveResult run() {
    host::Progress progress{"replay", input_.scans.size()};
    for (const ReplayScan& scan : input_.scans) {
      take(scan);
      progress.at(result_.trajectory.size());
    }
    mosaic_.absorb(map_.core());
    result_.map = mosaic_.image();
    return std::move(result_);
  }

 private:
  void take(const ReplayScan& scan) {
    const double begin_us = processor_time_us();
    const UndistortedSweep* const sweep = points_.of(scan);
    if (sweep == nullptr) { return; }
    // One logged pose a scan where scans are instants; the synthetic clock keeps them in step.
    const Pose2d odom_T_base = sweep->odom_T_base;
    LocaliserCounters& counters = result_.counters;
    ++counters.sweeps;
    if (first_) {
      map_T_base_ = input_.use_odometry ? odom_T_base : Pose2d{};
      map_.core().reset(map_T_base_.x_m, map_T_base_.y_m);
      matcher_->follow(map_T_base_);
    } else {
      localise(*sweep, between(last_odom_T_base_, odom_T_base));
    }
    first_ = false;
    last_odom_T_base_ = odom_T_base;
    matcher_->add(*sweep, map_T_base_);
    insert_scan(map_.core(), *sweep, map_T_base_, config_);
    ++counters.inserted;
    result_.total_us.push_back(processor_time_us() - begin_us);
    result_.trajectory.push_back({scan.logged_s, map_T_base_});
    result_.odometry.push_back(
        {scan.logged_s, scan.last_stamp > scan.stamp ? odom_T_base : scan.odom_T_base});
  }

  void localise(const UndistortedSweep& sweep, const Pose2d& motion) {
    const Pose2d guess = map_T_base_ * motion;
    mosaic_.watch(map_.core(), guess);
    map_.core().follow(guess.x_m, guess.y_m);
    matcher_->follow(guess);
    const GuessSigma sigma = sigma_of(motion, input_.use_odometry, config_.noise);
    const double begin_us = processor_time_us();
    const std::uint64_t heap_before = heap_trap::calls();
    heap_trap::enter();
    const ScanMatch match = matcher_->match(sweep, guess, sigma);
    heap_trap::leave();
    result_.heap_calls += heap_trap::calls() - heap_before;
    result_.match_us.push_back(processor_time_us() - begin_us);
    result_.iterations.push_back(match.report.iterations);
    LocaliserCounters& counters = result_.counters;
    ++counters.outcomes[static_cast<std::size_t>(match.report.outcome)];
    const bool found = is_pose(match.report.outcome);
    ++(found ? counters.matched : counters.rejected);
    map_T_base_ = found ? match.map_T_base : guess;
  }

  const ReplayInput& input_;
  LocaliserConfig config_;
  ScanPoints points_;
  ScanMap map_;
  std::unique_ptr<ScanMatcher> matcher_;
  host::MapMosaic mosaic_;
  DriveResult result_;
  Pose2d map_T_base_{};
  Pose2d last_odom_T_base_{};
  bool first_ = true;
};

}  // namespace

const UndistortedSweep* ScanPoints::of(const ReplayScan& scan) {
  if (scan.returns.size() > SiteProfile::kReturns) {
    throw host::UserError{host::ExitCode::refused, "",
                          fmt::format("line {}: {} beams, but a matcher takes {}", scan.line,
                                      scan.returns.size(), SiteProfile::kReturns),
                          ""};
  }
  while (next_pose_ < input_.poses.size() &&
         (poses_.size() == 0 || poses_.core().newest().stamp < scan.last_stamp)) {
    static_cast<void>(poses_.push(input_.poses[next_pose_]));
    ++next_pose_;
  }
  UndistortConfig config{.base_T_lidar = scan.base_T_lidar, .limits = scan.limits};
  config.reference = SweepReference::first_return;
  const Sweep sweep{scan.stamp, scan.last_stamp, 0, scan.returns};
  if (!is_ok(undistorter_.begin(config, sweep)) ||
      !is_ok(undistorter_.step(poses_.core(), SiteProfile::kReturns))) {
    return nullptr;
  }
  return &undistorter_.result();
}

DriveResult replay_with_matcher(const ReplayInput& input, const ReplaySettings& settings,
                                MatcherKind kind) {
  return std::make_unique<MatcherReplay>(input, settings, kind)->run();
}

}  // namespace picolo::tool
