// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "wire_replay.hpp"

#include <fmt/format.h>

#include <memory>
#include <span>

#include "given_map.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/heap_trap/heap_trap.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/map_mosaic.hpp"
#include "picolo/host/progress.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "processor_time.hpp"
#include "sweep_times.hpp"
#include "wire_vehicle.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kFlashPerCell = 3;  // bytes of two slots, as long as the worst map
constexpr std::size_t kFlashSector = 4096;
constexpr std::size_t kFlashGranule = 8;
constexpr std::size_t kMapPieces = 1024;

template <Profile P>
class WireReplay {
 public:
  WireReplay(const ReplayInput& input, const ReplaySettings& settings,
             std::span<const sim::LogStep> steps)
      : input_{input},
        save_map_{settings.save_map},
        player_{player_config(), steps},
        wheels_{player_.can(), wheels_config()},
        lidar_{player_.lidar_port()},
        controller_{{player_.can(), player_.clock(), cycles_, player_.watchdog()},
                    wheels_,
                    lidar_,
                    imu_,
                    events_,
                    controller_config(input, settings)},
        times_{controller_.pipeline()},
        poses_(input.scans.size()) {
    if (!settings.map.empty()) { load(settings); }
  }

  DriveResult run() {
    host::Progress progress{"replay through wires", input_.scans.size()};
    Status status = controller_.start();
    while (!player_.finished() && status == Status::ok) {
      status = run_frame();
      watch_step();
      watch_match();
      progress.at(player_.steps_played());
    }
    close_step();
    if (status != Status::ok) {
      throw host::UserError{host::ExitCode::refused, "",
                            fmt::format("the controller stopped: {}", to_string(status)),
                            "check the [localiser] settings"};
    }
    return finish();
  }

  [[nodiscard]] std::size_t missed() const { return missed_; }

 private:
  struct StepPose {
    Pose2d map_T_base{};
    Pose2d odom_T_base{};
    bool standing = false;  // published while the vehicle stood there
    bool matched = false;   // from the match of the scan itself
  };

  [[nodiscard]] const LocaliserCore& localiser() const {
    return controller_.pipeline().localiser();
  }

  /// As a vehicle does: from a byte store.
  void load(const ReplaySettings& settings) {
    const auto map = std::make_unique<RollingMap<P::kWidth, P::kHeight>>(
        fine_map_config<P>(settings.localiser.map));
    const Pose2d frame_T_map = GivenMap{settings.map}.restore(map->core(), P::kName);
    if (frame_T_map.x_m != 0.0 || frame_T_map.y_m != 0.0) {
      throw host::UserError{host::ExitCode::usage, settings.map,
                            "its origin is no whole number of cells from zero, as --wire needs it",
                            "replay without --wire"};
    }
    std::vector<std::uint8_t> flash(kFlashPerCell * map->core().occupancy().size());
    sim::SimByteStore medium{flash, kFlashSector, kFlashGranule};
    MapStore store{medium};
    Status status = store.begin_save(map->core());
    if (is_ok(status)) {
      do { status = store.step(kMapPieces); } while (status == Status::not_ready);
    }
    if (is_ok(status)) { status = controller_.load_map(store); }
    if (!is_ok(status)) {
      throw host::UserError{host::ExitCode::refused, settings.map,
                            fmt::format("the controller refuses the map: {}", to_string(status)),
                            "replay without --wire"};
    }
  }

  Status run_frame() {
    const std::uint64_t before = heap_trap::calls();
    heap_trap::enter();
    player_.advance_to(controller_.next_frame());
    const Status status = controller_.run_frame(times_);
    heap_trap::leave();
    result_.heap_calls += heap_trap::calls() - before;
    return status;
  }

  /// The log's odometry frame begins where the wheels' begins.
  [[nodiscard]] Pose2d in_log_frame(const Pose2d& odom_T_base) const {
    return input_.scans.front().odom_T_base * odom_T_base;
  }

  void watch_step() {
    if (player_.steps_played() != steps_seen_) {
      close_step();
      steps_seen_ = player_.steps_played();
    }
    if (steps_seen_ == 0 || poses_[steps_seen_ - 1].standing) { return; }
    StepPose& pose = poses_[steps_seen_ - 1];
    const PoseEstimate& estimate = controller_.estimate();
    pose = {estimate.map_T_base, in_log_frame(estimate.odom_T_base), true, pose.matched};
  }

  void watch_match() {
    const MatchVerdict& verdict = controller_.pipeline().verdict();
    if (verdict.reference == last_reference_) { return; }
    last_reference_ = verdict.reference;
    const Result<std::size_t> step = player_.step_at(verdict.reference);
    if (!step || *step >= poses_.size()) { return; }
    poses_[*step] = {verdict.map_T_base, in_log_frame(verdict.odom_T_base), true, true};
    const std::uint32_t matches = localiser().counters().sweeps;
    if (matches > 1) { result_.iterations.push_back(localiser().report().iterations); }
    mosaic_.watch(localiser().map(), verdict.map_T_base);
  }

  void close_step() {
    if (steps_seen_ > 0) {
      const PoseEstimate& estimate = controller_.estimate();
      result_.health.at_scan(input_.scans[steps_seen_ - 1].logged_s, steps_seen_ - 1,
                             estimate.state, estimate.reason);
    }
    if (steps_seen_ > 0 && times_.total_us() > 0.0) {
      result_.total_us.push_back(times_.total_us());
      if (steps_seen_ > 1) { result_.match_us.push_back(times_.match_us()); }
    }
    times_.reset();
  }

  DriveResult finish() {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const double stamp_s = input_.scans[i].logged_s;
      result_.trajectory.push_back({stamp_s, poses_[i].map_T_base});
      result_.odometry.push_back({stamp_s, poses_[i].odom_T_base});
      missed_ += poses_[i].matched ? 0U : 1U;
    }
    mosaic_.absorb(localiser().map());
    result_.map = mosaic_.image();
    result_.counters = localiser().counters();
    if (!save_map_.empty()) { save_map(localiser().map(), save_map_); }
    return std::move(result_);
  }

  const ReplayInput& input_;
  std::string save_map_;
  sim::LogPlayer player_;
  ProcessorTimeCounter cycles_;
  CanopenWheels wheels_;
  Ld06 lidar_;
  NoImu imu_;
  EventRing events_{};
  Controller<P, CanopenWheels, Ld06, NoImu> controller_;
  SweepTimes times_;
  host::MapMosaic mosaic_;
  std::vector<StepPose> poses_;
  std::size_t steps_seen_ = 0;
  std::size_t missed_ = 0;
  Timestamp last_reference_{};
  DriveResult result_;
};

template <Profile P>
DriveResult replay_in(const ReplayInput& input, const ReplaySettings& settings,
                      host::Diagnostics& diagnostics) {
  const auto beams = beams_of(input);
  const auto steps = steps_of(input, beams);
  const auto replay = std::make_unique<WireReplay<P>>(input, settings, steps);
  DriveResult result = replay->run();
  if (replay->missed() > 0) {
    diagnostics.warn("", fmt::format("{} of {} scans were not taken by the controller",
                                     replay->missed(), input.scans.size()));
  }
  return result;
}

void refuse_unfit(const ReplayInput& input) {
  for (const ReplayScan& scan : input.scans) {
    if (scan.last_stamp > scan.stamp) {
      throw host::UserError{host::ExitCode::usage, "",
                            "--wire plays scans of an instant, not sweeps with times of beams",
                            "replay this log without --wire"};
    }
  }
  if (!input.use_odometry) {
    throw host::UserError{host::ExitCode::usage, "",
                          "--wire needs odometry: the wheels of its vehicle turn by it",
                          "replay this log without --wire"};
  }
}

}  // namespace

DriveResult replay_through_wires(const ReplayInput& input, const ReplaySettings& settings,
                                 host::Diagnostics& diagnostics) {
  refuse_unfit(input);
  if (settings.profile == RoomProfile::kName) {
    return replay_in<RoomProfile>(input, settings, diagnostics);
  }
  if (settings.profile == HallProfile::kName) {
    return replay_in<HallProfile>(input, settings, diagnostics);
  }
  if (settings.profile == SiteProfile::kName) {
    return replay_in<SiteProfile>(input, settings, diagnostics);
  }
  throw host::UserError{host::ExitCode::usage, "", "unknown profile '" + settings.profile + "'",
                        "choose room, hall or site"};
}

}  // namespace picolo::tool
