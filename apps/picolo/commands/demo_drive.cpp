// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands/demo_drive.hpp"

#include <algorithm>
#include <memory>

#include "live/live_loop.hpp"
#include "picolo/heap_trap/heap_trap.hpp"
#include "picolo/host/map_image.hpp"
#include "picolo/host/quantile.hpp"
#include "picolo/simulated/simulated_controller.hpp"
#include "processor_time.hpp"

namespace picolo::tool {
namespace {

using Robot = SimulatedController<SiteProfile>;

constexpr int kFramesPerSecond = 200;
constexpr int kFramesPerPose = 20;

/// Keeps the length of every run, in memory taken beforehand.
class TaskTimes {
 public:
  explicit TaskTimes(std::size_t frames) {
    for (auto& runs : runs_) { runs.reserve(frames); }
  }
  void ran(std::size_t task, std::uint32_t cycles) { runs_[task].push_back(cycles); }
  [[nodiscard]] TaskTime summary(std::size_t task, const TaskEntry& entry,
                                 double cycles_per_us) const {
    const auto& runs = runs_[task];
    std::vector<double> times_us;
    times_us.reserve(runs.size());
    for (const std::uint32_t cycles : runs) { times_us.push_back(cycles / cycles_per_us); }
    const double worst_us =
        times_us.empty() ? 0.0 : *std::max_element(times_us.begin(), times_us.end());
    return {entry.name, host::quantile(std::move(times_us), 0.5), worst_us};
  }

 private:
  std::array<std::vector<std::uint32_t>, kControllerTasks> runs_;
};

void keep_pose(const Robot& robot, DemoResult& result) {
  const PoseEstimate& estimate = robot.controller().estimate();
  const Result<Pose2d> truth = robot.true_map_T_base(estimate.stamp);
  if (estimate.matches == 0 || !truth) { return; }
  const double stamp_s = to_seconds_f64(estimate.stamp.time_since_epoch());
  result.trajectory.push_back({stamp_s, estimate.map_T_base});
  result.odometry.push_back({stamp_s, estimate.odom_T_base});
  result.truth.push_back({stamp_s, *truth});
  result.tracking_share += estimate.state == HealthState::tracking ? 1.0 : 0.0;
}

/// The same drive with ports that write down what they deliver.
DemoResult drive_and_record(const DemoSettings& settings,
                            const std::function<void(std::size_t)>& progress) {
  const sim::SimulationConfig config{.seed = settings.seed};
  const auto simulation = std::make_unique<sim::Simulation>(config);
  Recorder recorder{settings.record, "", simulation->can(), simulation->lidar_port(),
                    simulation->imu_port()};
  LatchedClock clock;
  const auto vehicle = make_vehicle(
      read_vehicle(""),
      {.board = {recorder.can(), clock, simulation->cycle_counter(), simulation->watchdog()},
       .lidar = recorder.lidar(),
       .imu = recorder.imu()});
  LiveLoop loop{*vehicle, clock, &recorder};
  DemoResult result;
  loop.start(simulation->now());
  for (int frame = 0; frame < settings.seconds * kFramesPerSecond; ++frame) {
    simulation->advance_to(vehicle->next_frame());
    static_cast<void>(loop.cycle(simulation->now()));
    const PoseEstimate& estimate = vehicle->estimate();
    const Result<sim::Truth> truth = simulation->truth(estimate.stamp);
    if (frame % kFramesPerPose == kFramesPerPose - 1 && estimate.matches > 0 && truth) {
      result.truth.push_back({to_seconds_f64(estimate.stamp.time_since_epoch()),
                              between(config.scene.world_T_start, truth->world_T_base)});
      result.tracking_share += estimate.state == HealthState::tracking ? 1.0 : 0.0;
    }
    if (frame % kFramesPerSecond == 0) {
      progress(static_cast<std::size_t>(frame / kFramesPerSecond));
    }
  }
  loop.finish();
  result.trajectory = loop.journal().trajectory();
  result.odometry = loop.journal().odometry();
  result.map = vehicle->map();
  result.counters = vehicle->figures().localiser;
  result.tracking_share /= std::max(1.0, static_cast<double>(result.trajectory.size()));
  result.state = vehicle->estimate().state;
  result.reason = vehicle->estimate().reason;
  return result;
}

}  // namespace

DemoResult drive_demo(const DemoSettings& settings,
                      const std::function<void(std::size_t)>& progress) {
  if (!settings.record.empty()) { return drive_and_record(settings, progress); }
  const int frames = settings.seconds * kFramesPerSecond;
  ProcessorTimeCounter cycles;
  TaskTimes times{static_cast<std::size_t>(frames)};
  const auto robot = std::make_unique<Robot>(sim::SimulationConfig{.seed = settings.seed},
                                             VehicleSettings{}.controller, &cycles);
  DemoResult result;
  Status status = robot->start();
  for (int frame = 0; frame < frames && status == Status::ok; ++frame) {
    const std::uint64_t heap_calls_before = heap_trap::calls();
    {
      const heap_trap::Guard guard;
      status = robot->run_frame(times);
    }
    result.heap_calls += heap_trap::calls() - heap_calls_before;
    if (frame % kFramesPerPose == kFramesPerPose - 1) { keep_pose(*robot, result); }
    if (frame % kFramesPerSecond == 0) {
      progress(static_cast<std::size_t>(frame / kFramesPerSecond));
    }
  }
  const auto& controller = robot->controller();
  result.map = host::crop(host::image_of(controller.pipeline().localiser().map()), 10);
  result.counters = controller.pipeline().localiser().counters();
  for (std::size_t task = 0; task < kControllerTasks; ++task) {
    result.tasks.push_back(
        times.summary(task, controller.schedule().entry(task), cycles.cycles_per_us()));
  }
  result.tracking_share /= std::max(1.0, static_cast<double>(result.trajectory.size()));
  result.state = controller.supervisor().state();
  result.reason = controller.supervisor().reason();
  return result;
}

}  // namespace picolo::tool
