// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "direct_replay.hpp"

#include <fmt/format.h>

#include <memory>

#include "given_map.hpp"
#include "picolo/heap_trap/heap_trap.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/map_mosaic.hpp"
#include "picolo/host/progress.hpp"
#include "processor_time.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kRaysPerStep = 4096;

template <Profile P>
class DirectReplay {
 public:
  DirectReplay(const ReplayInput& input, const ReplaySettings& settings)
      : input_{input},
        save_map_{settings.save_map},
        localiser_{settings.localiser},
        health_{!settings.map.empty()} {
    if (!settings.map.empty()) {
      frame_T_map_ = GivenMap{settings.map}.restore(core().restorable_map(), P::kName);
      static_cast<void>(core().localise_in_restored_map());
    }
    Pose2d odom_T_base{};
    if (input.use_odometry && !input.poses.empty()) {
      odom_T_base = input.poses.front().odom_T_base;
    }
    const Pose2d start = settings.map_T_start.value_or(odom_T_base);
    core().set_pose(inverse(frame_T_map_) * start, odom_T_base);
    health_.guide(core());
  }

  DriveResult run() {
    host::Progress progress{"replay", input_.scans.size()};
    for (const ReplayScan& scan : input_.scans) {
      take(scan);
      progress.at(result_.trajectory.size());
    }
    mosaic_.absorb(core().map());
    result_.map = mosaic_.image();
    result_.counters = core().counters();
    move_into_frame(frame_T_map_, result_);
    if (!save_map_.empty()) { save_map(core().map(), save_map_); }
    return std::move(result_);
  }

 private:
  LocaliserCore& core() { return localiser_.core(); }

  void take(const ReplayScan& scan) {
    if (scan.returns.size() > P::kReturns) {
      throw host::UserError{host::ExitCode::refused, "",
                            fmt::format("line {}: {} beams, but profile {} takes {}", scan.line,
                                        scan.returns.size(), P::kName, P::kReturns),
                            "choose a larger one with --profile"};
    }
    mosaic_.watch(core().map(), core().map_T_base());
    while (next_pose_ < input_.poses.size() &&
           (poses_.size() == 0 || poses_.core().newest().stamp < scan.last_stamp)) {
      static_cast<void>(poses_.push(input_.poses[next_pose_]));
      ++next_pose_;
    }
    const double begin_us = processor_time_us();
    const std::uint64_t heap_before = heap_trap::calls();
    heap_trap::enter();
    const bool done = localise(scan);
    heap_trap::leave();
    result_.heap_calls += heap_trap::calls() - heap_before;
    if (!done) { return; }
    result_.total_us.push_back(processor_time_us() - begin_us);
    if (matched_) {
      result_.match_us.push_back(match_us_);
      result_.iterations.push_back(iterations_);
    }
    result_.trajectory.push_back({scan.logged_s, core().map_T_base()});
    result_.odometry.push_back({scan.logged_s, logged_odometry(scan)});
    health_.judge(scan.stamp, core(), core().report().points == 0 && core().accepted());
    health_.guide(core());
    result_.health.at_scan(scan.logged_s, result_.trajectory.size() - 1, health_.state(),
                           health_.reason());
  }

  /// False when odometry does not cover the sweep.
  bool localise(const ReplayScan& scan) {
    const Sweep sweep{scan.stamp, scan.last_stamp, 0, scan.returns};
    UndistortConfig config{.base_T_lidar = scan.base_T_lidar, .limits = scan.limits};
    config.reference = SweepReference::first_return;
    if (!is_ok(undistorter_.begin(config, sweep)) ||
        !is_ok(undistorter_.step(poses_.core(), P::kReturns))) {
      return false;
    }
    const double begin_us = processor_time_us();
    if (!is_ok(core().begin(undistorter_.result(), input_.use_odometry))) { return false; }
    matched_ = core().phase() == LocaliserPhase::matching;
    while (!core().match_step()) {}
    iterations_ = core().report().iterations;
    match_us_ = processor_time_us() - begin_us;
    while (!core().map_step(kRaysPerStep)) {}
    return true;
  }

  [[nodiscard]] Pose2d logged_odometry(const ReplayScan& scan) const {
    return scan.last_stamp > scan.stamp ? undistorter_.result().odom_T_base : scan.odom_T_base;
  }

  const ReplayInput& input_;
  std::string save_map_;
  PoseBuffer<256> poses_;
  Undistorter<P::kReturns> undistorter_;
  Localiser<P> localiser_;
  host::MapMosaic mosaic_;
  ScanHealth health_;
  Pose2d frame_T_map_{};
  DriveResult result_;
  std::size_t next_pose_ = 0;
  double match_us_ = 0.0;
  int iterations_ = 0;
  bool matched_ = false;
};

template <Profile P>
DriveResult replay_in(const ReplayInput& input, const ReplaySettings& settings) {
  return std::make_unique<DirectReplay<P>>(input, settings)->run();  // megabytes: not on the stack
}

}  // namespace

DriveResult replay_directly(const ReplayInput& input, const ReplaySettings& settings) {
  if (settings.profile == RoomProfile::kName) { return replay_in<RoomProfile>(input, settings); }
  if (settings.profile == HallProfile::kName) { return replay_in<HallProfile>(input, settings); }
  if (settings.profile == SiteProfile::kName) { return replay_in<SiteProfile>(input, settings); }
  throw host::UserError{host::ExitCode::usage, "", "unknown profile '" + settings.profile + "'",
                        "choose room, hall or site"};
}

}  // namespace picolo::tool
