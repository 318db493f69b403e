// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "drives.hpp"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "picolo/host/carmen.hpp"
#include "picolo/sim/log_player.hpp"
#include "picolo/simulated/simulated_controller.hpp"
#include "picolo/simulated/trajectory_hash.hpp"

namespace picolo::target {
namespace {

class SimulatedDrive final : public Drive {
 public:
  SimulatedDrive(const sim::SimulationConfig& config, Duration length,
                 std::vector<TimedCommand> commands)
      : simulation_(config), end_(simulation_.now() + length), commands_(std::move(commands)) {}
  Timestamp now() override { return simulation_.now(); }
  void advance_to(Timestamp now) override {
    simulation_.advance_to(now);
    while (sent_ < commands_.size() && now - simulation_.config().start >= commands_[sent_].after) {
      Command command = commands_[sent_].command;
      command.counter = static_cast<std::uint8_t>(++sent_);
      command.tick = can_tick(now);
      CanFrame frame = encode_command(FramesOutConfig{}.base_id, command);
      frame.stamp = now;
      simulation_.can().deliver(frame);
    }
  }
  bool over() override { return simulation_.now() >= end_; }
  sim::SimCanBus& can() override { return simulation_.can(); }
  sim::SimSerialPort& lidar_port() override { return simulation_.lidar_port(); }
  sim::SimSerialPort* imu_port() override { return &simulation_.imu_port(); }
  [[nodiscard]] bool recorded() const override { return false; }
  std::optional<Pose2d> true_map_T_base(Timestamp stamp) override {
    const Result<sim::Truth> truth = simulation_.truth(stamp);
    if (!truth) { return std::nullopt; }
    return between(simulation_.config().scene.world_T_start, truth->world_T_base);
  }

 private:
  sim::Simulation simulation_;
  Timestamp end_;
  std::vector<TimedCommand> commands_;
  std::size_t sent_ = 0;
};

/// Counts of the vehicle that images are configured for.
sim::LogPlayerConfig player_config() {
  const DifferentialDriveConfig drive = simulated_vehicle_config().drive;
  sim::LogPlayerConfig config;
  config.script.metres_per_count =
      2.0 * std::numbers::pi * drive.left_radius_m / drive.counts_per_revolution;
  config.script.track_m = drive.track_m;
  config.think_time = 200ms;
  return config;
}

class RecordedDrive final : public Drive {
 public:
  RecordedDrive(const std::string& file, std::size_t skip, std::size_t scans)
      : steps_(read(file, skip, scans)), player_(player_config(), steps_) {}
  Timestamp now() override { return player_.now(); }
  void advance_to(Timestamp now) override { player_.advance_to(now); }
  bool over() override { return player_.finished(); }
  sim::SimCanBus& can() override { return player_.can(); }
  sim::SimSerialPort& lidar_port() override { return player_.lidar_port(); }
  sim::SimSerialPort* imu_port() override { return nullptr; }
  [[nodiscard]] bool recorded() const override { return true; }
  std::optional<Pose2d> true_map_T_base(Timestamp /*stamp*/) override { return std::nullopt; }

 private:
  std::vector<sim::LogStep> read(const std::string& file, std::size_t skip, std::size_t scans) {
    host::LineReader reader(file);
    host::Diagnostics diagnostics;
    const host::CarmenLog log = host::read_carmen(reader, diagnostics);
    const std::size_t end = std::min(log.scans.size(), skip + scans);
    // The laser of the log stands where the vehicle has its own.
    const Pose2d lidar_T_base = inverse(to_f64(simulated_vehicle_config().undistort.base_T_lidar));
    beams_.resize(end - skip);
    std::vector<sim::LogStep> steps;
    for (std::size_t i = skip; i < end; ++i) {
      const host::LogScan& scan = log.scans[i];
      std::vector<sim::RecordedBeam>& beams = beams_[i - skip];
      for (std::size_t k = 0; k < scan.ranges_m.size(); ++k) {
        beams.push_back({scan.ranges_m[k], scan.bearings_rad[k]});
      }
      steps.push_back({scan.odom_T_base * lidar_T_base, beams});
    }
    return steps;
  }

  std::vector<std::vector<sim::RecordedBeam>> beams_;
  std::vector<sim::LogStep> steps_;
  sim::LogPlayer player_;
};

}  // namespace

std::unique_ptr<Drive> simulated_drive(const sim::SimulationConfig& config, Duration length,
                                       std::vector<TimedCommand> commands) {
  return std::make_unique<SimulatedDrive>(config, length, std::move(commands));
}

std::unique_ptr<Drive> simulated_drive(sim::SceneName scene, Duration length) {
  return simulated_drive(hashed_drive(scene), length);
}

std::unique_ptr<Drive> recorded_drive(const std::string& file, std::size_t skip,
                                      std::size_t scans) {
  return std::make_unique<RecordedDrive>(file, skip, scans);
}

}  // namespace picolo::target
