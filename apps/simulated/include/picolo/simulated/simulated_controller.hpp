// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The installed controller with the real drivers, on the simulated vehicle's wires.
#pragma once

#include "picolo/controller/controller.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/sim/simulation.hpp"

namespace picolo::inline v0 {

/// What a technician would configure for the simulated vehicle: its nominal sizes, not its true
/// ones.
[[nodiscard]] constexpr ControllerConfig simulated_vehicle_config() {
  ControllerConfig config;
  config.drive = {
      .left_radius_m = 0.1, .right_radius_m = 0.1, .track_m = 0.5, .counts_per_revolution = 4096.0};
  config.undistort.base_T_lidar = {0.12F, 0.0F, 0.0F};
  config.undistort.limits = {.min_m = 0.05F, .max_m = 12.0F};
  config.localiser.uncertainty.odometry = {.walk_m = 0.0105F,
                                           .heading_walk_rad = 0.0015F,
                                           .sideways_m = 0.0025F,
                                           .scale = 0.001F,
                                           .heading_per_m_rad = 0.0F,
                                           .heading_per_s_rad = 0.00063F,
                                           .heading_scale = 0.0035F};
  return config;
}

/// Its drives as they come: the firmware sends SYNC.
[[nodiscard]] constexpr CanopenWheelsConfig simulated_wheels_config(
    const sim::WheelPairConfig& pair = {}) {
  CanopenWheelsConfig config = two_cia402_drives(pair.left.node, pair.right.node);
  config.produce_sync = true;
  return config;
}

/// About 1 MB more than the profile's controller: keep it off the stack. The controller's map frame
/// is world_T_start.
template <Profile P>
class SimulatedController {
 public:
  using Type = Controller<P, CanopenWheels, Ld06, WitMotion>;

  /// The simulation's own cycle counter stands still during a frame; `cycle_counter` replaces it to
  /// measure this machine's time. Either way no decision depends on it.
  explicit SimulatedController(const sim::SimulationConfig& simulation,
                               const ControllerConfig& config = simulated_vehicle_config(),
                               CycleCounter* cycle_counter = nullptr,
                               const ControllerServices& services = {})
      : simulation_(simulation),
        wheels_(simulation_.can(), simulated_wheels_config(simulation.wheels)),
        lidar_(simulation_.lidar_port()),
        imu_(simulation_.imu_port()),
        controller_({simulation_.can(), simulation_.clock(),
                     cycle_counter != nullptr ? *cycle_counter : simulation_.cycle_counter(),
                     simulation_.watchdog()},
                    wheels_, lidar_, imu_, events_, config, services) {}
  SimulatedController(const SimulatedController&) = delete;
  SimulatedController& operator=(const SimulatedController&) = delete;
  ~SimulatedController() = default;

  Status start() { return controller_.start(); }
  /// Lets the world live until the next frame, then runs that.
  template <TaskObserver Observer>
  Status run_frame(Observer& observer) {
    simulation_.advance_to(controller_.next_frame());
    return controller_.run_frame(observer);
  }
  Status run_frame() {
    NoTaskObserver nobody;
    return run_frame(nobody);
  }

  /// The truth in the controller's map frame at an instant of the last 8 s.
  [[nodiscard]] Result<Pose2d> true_map_T_base(Timestamp stamp) const {
    const Result<sim::Truth> truth = simulation_.truth(stamp);
    if (!truth) { return truth.status(); }
    return between(simulation_.config().scene.world_T_start, truth->world_T_base);
  }

  [[nodiscard]] sim::Simulation& simulation() { return simulation_; }
  [[nodiscard]] const sim::Simulation& simulation() const { return simulation_; }
  [[nodiscard]] Type& controller() { return controller_; }
  [[nodiscard]] const Type& controller() const { return controller_; }
  [[nodiscard]] const CanopenWheels& wheels() const { return wheels_; }
  [[nodiscard]] const Ld06& lidar() const { return lidar_; }
  [[nodiscard]] const WitMotion& imu() const { return imu_; }
  [[nodiscard]] const EventRing& events() const { return events_; }

 private:
  sim::Simulation simulation_;
  CanopenWheels wheels_;
  Ld06 lidar_;
  WitMotion imu_;
  EventRing events_{};
  Type controller_;
};

}  // namespace picolo::inline v0
