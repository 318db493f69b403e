// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle on its wires; faults come between drivers and controller.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "faulty_devices.hpp"
#include "picolo/simulated/simulated_controller.hpp"
#include "subject.hpp"

namespace picolo::test {

class SimulatedSubject final : public Subject {
 public:
  SimulatedSubject(sim::SceneName scene, std::uint64_t seed)
      : simulation_({.seed = seed, .scene = sim::make_scene(scene)}),
        wheels_driver_(simulation_.can(), wheels_config()),
        lidar_driver_(simulation_.lidar_port()),
        imu_driver_(simulation_.imu_port()),
        wheels_(wheels_driver_),
        lidar_(lidar_driver_, simulation_.clock()),
        imu_(imu_driver_, simulation_.clock()),
        controller_({simulation_.can(), simulation_.clock(), simulation_.cycle_counter(),
                     simulation_.watchdog()},
                    wheels_, lidar_, imu_, events_, simulated_vehicle_config()) {
    static_cast<void>(controller_.start());
  }

  void run_frame() override {
    simulation_.advance_to(controller_.next_frame());
    static_cast<void>(controller_.run_frame());
  }
  [[nodiscard]] Timestamp now() const override { return controller_.last_frame().start; }
  [[nodiscard]] bool moving() const override {
    const Result<sim::Truth> truth = simulation_.truth(now());
    return truth &&
           (std::abs(truth->twist.x_mps) > 0.1F || std::abs(truth->twist.omega_radps) > 0.2F);
  }
  void inject(const Fault& fault) override {
    wheels_.inject(fault);
    lidar_.inject(fault);
    imu_.inject(fault);
  }

  [[nodiscard]] Publication publication() const override {
    const PoseEstimate& estimate = controller_.estimate();
    Publication publication{.now = now(),
                            .stamp = estimate.stamp,
                            .map_T_base = estimate.map_T_base,
                            .odom_T_base = estimate.odom_T_base,
                            .state = estimate.state,
                            .reason = estimate.reason,
                            .tilted = controller_.pipeline().tilted()};
    publication.accelerometer_doubted =
        (controller_.supervisor().doubts() & doubt_of(SensorIndex::accelerometer)) != 0;
    publication.imu_silent = estimate.reason == HealthReason::gyro_silent;
    const Result<sim::Truth> truth = simulation_.truth(estimate.stamp);
    if (!truth) { return publication; }
    publication.truth = between(simulation_.config().scene.world_T_start, truth->world_T_base);
    publication.knows_truth = true;
    publication.nees = nees(estimate, publication.truth);
    return publication;
  }

  /// From now on the vehicle stands on a slope to its side, for a while.
  void lean(Duration after, Duration length) override {
    imu_.tilt(now() + after, now() + after + length, 0.26F);
  }
  [[nodiscard]] const auto& controller() const { return controller_; }

 private:
  static CanopenWheelsConfig wheels_config() {
    CanopenWheelsConfig config = two_cia402_drives(1, 2);
    config.produce_sync = true;
    return config;
  }
  [[nodiscard]] static double nees(const PoseEstimate& estimate, const Pose2d& truth);

  sim::Simulation simulation_;
  CanopenWheels wheels_driver_;
  Ld06 lidar_driver_;
  WitMotion imu_driver_;
  FaultyWheels<CanopenWheels> wheels_;
  FaultyLidar<Ld06> lidar_;
  FaultyImu<WitMotion> imu_;
  EventRing events_{};
  Controller<RoomProfile, FaultyWheels<CanopenWheels>, FaultyLidar<Ld06>, FaultyImu<WitMotion>>
      controller_;
};

/// e' (match + drift)^-1 e in map axes, by elimination.
inline double SimulatedSubject::nees(const PoseEstimate& estimate, const Pose2d& truth) {
  std::array<std::array<double, 4>, 3> rows{};
  const Pose2d& pose = estimate.map_T_base;
  const std::array<double, 3> error{
      pose.x_m - truth.x_m, pose.y_m - truth.y_m,
      std::remainder(pose.theta_rad - truth.theta_rad, 2.0 * std::numbers::pi)};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t row = r;
      const std::size_t column = c;
      rows[r][c] = static_cast<double>(estimate.match_covariance(row, column)) +
                   static_cast<double>(estimate.drift_covariance(row, column));
    }
    rows[r][3] = error[r];
  }
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t below = r + 1; below < 3; ++below) {
      const double factor = rows[below][r] / rows[r][r];
      for (std::size_t c = r; c < 4; ++c) { rows[below][c] -= factor * rows[r][c]; }
    }
  }
  double sum = 0.0;  // L D L': the square of each reduced error over its pivot
  for (std::size_t r = 0; r < 3; ++r) { sum += rows[r][3] * rows[r][3] / rows[r][r]; }
  return sum;
}

}  // namespace picolo::test
