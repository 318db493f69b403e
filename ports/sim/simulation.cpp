// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/simulation.hpp"

#include <numbers>

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::size_t kStoreSector = 4096;
constexpr std::size_t kStoreGranule = 8;
constexpr std::int64_t kCountLimit = std::int64_t{1} << 52;

}  // namespace

Simulation::Shaft::Shaft(const Vehicle& vehicle, std::size_t wheel, std::uint32_t counts_per_turn,
                         Timestamp start)
    : vehicle_(vehicle), wheel_(wheel), counts_per_turn_(counts_per_turn), start_(start) {}

EncoderReading Simulation::Shaft::reading_at(Timestamp instant) {
  const VehicleState state = vehicle_.at(instant - start_).value_or(vehicle_.state());
  const double counts_per_rad = static_cast<double>(counts_per_turn_) / (2.0 * std::numbers::pi);
  return {.counts = round_to_i64(state.wheel_angle_rad[wheel_] * counts_per_rad, -kCountLimit,
                                 kCountLimit),
          .counts_per_s = round_to_i64(state.wheel_rate_radps[wheel_] * counts_per_rad,
                                       -kCountLimit, kCountLimit)};
}

Simulation::Simulation(const SimulationConfig& config)
    : config_(config),
      clock_(config.start),
      cycle_counter_(clock_),
      watchdog_(clock_, config.watchdog_period),
      can_(clock_, config.can_bit_rate),
      lidar_port_(clock_, kLd06Baud),
      imu_port_(clock_, config.imu.baud),
      store_(store_memory_, kStoreSector, kStoreGranule),
      faults_(config.seed, config.faults),
      vehicle_(config.vehicle, config.scene.world_T_start, config.seed),
      plan_(config.drive, config.scene.route, config.scene.closed, config.script),
      lidar_(config.lidar, config.start, config.seed),
      imu_(config.imu, config.start, config.seed),
      lidar_link_(lidar_port_, faults_, Device::lidar, config.start),
      imu_link_(imu_port_, faults_, Device::imu, config.start),
      left_shaft_(vehicle_, 0, config.counts_per_turn, config.start),
      right_shaft_(vehicle_, 1, config.counts_per_turn, config.start),
      wheels_(config.wheels, left_shaft_, right_shaft_, can_, faults_, config.start) {}

void Simulation::advance_to(Timestamp now) {
  // Whole steps only, so that nothing depends on how time is cut into calls; what they produce
  // beyond `now` is still under way on the wires.
  while (config_.start + vehicle_.state().elapsed < now) { live_one_step(); }
  clock_.set(now);
}

void Simulation::live_one_step() {
  vehicle_.step(plan_.next(vehicle_.state()));
  const Duration elapsed = vehicle_.state().elapsed;
  const Timestamp until = config_.start + elapsed;
  lidar_link_.update(until);
  imu_link_.update(until);
  wheels_.advance_to(until);
  lidar_.advance_to(elapsed, config_.scene.world, vehicle_, lidar_link_);
  imu_.advance_to(elapsed, vehicle_, imu_link_);
}

Truth Simulation::truth() {
  return to_truth(vehicle_.at(now() - config_.start).value_or(vehicle_.state()));
}

Result<Truth> Simulation::truth(Timestamp stamp) const {
  const Result<VehicleState> state = vehicle_.at(stamp - config_.start);
  if (!state) { return state.status(); }
  return to_truth(*state);
}

Truth Simulation::to_truth(const VehicleState& state) const {
  return {.stamp = config_.start + state.elapsed,
          .world_T_base = state.world_T_base,
          .twist = {.x_mps = static_cast<float>(state.speed_mps),
                    .y_mps = static_cast<float>(state.lateral_mps),
                    .omega_radps = static_cast<float>(state.omega_radps)},
          .wheel_angle_rad = state.wheel_angle_rad};
}

}  // namespace picolo::inline v0::sim
