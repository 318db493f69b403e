// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/ld06_model.hpp"

#include <numbers>

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::uint64_t kStream = 12;
constexpr std::uint8_t kHitIntensity = 200;

/// Share of a turn, in [0, 1), at which a point lies.
double turn_share(const Ld06ModelConfig& config, std::int64_t index) {
  const double turns = static_cast<double>(index) *
                       (config.rotation_hz / static_cast<double>(config.points_per_second));
  return turns - static_cast<double>(floor_to_i32(turns, 0, 0x7FFF'FFFF));
}

}  // namespace

Ld06Model::Ld06Model(const Ld06ModelConfig& config, Timestamp start, std::uint64_t seed)
    : config_(config), start_(start), random_(seed, kStream) {
  packet_.speed_dps =
      static_cast<std::uint16_t>(round_to_i64(360.0 * config.rotation_hz, 0, 0xFFFF));
}

Duration Ld06Model::point_time(std::int64_t index) const {
  return Duration{index * 1'000'000 / config_.points_per_second};
}

std::uint16_t Ld06Model::point_angle_cdeg(std::int64_t index) const {
  const std::int64_t cdeg = round_to_i64(36'000.0 * turn_share(config_, index), 0, 36'000);
  return static_cast<std::uint16_t>(cdeg % 36'000);
}

void Ld06Model::advance_to(Duration until, const World& world, const Vehicle& vehicle,
                           SerialLink& link) {
  while (point_time(next_point_) <= until) {
    const Duration when = point_time(next_point_);
    const auto slot = static_cast<std::size_t>(next_point_) % kLd06Points;
    if (slot == 0) { packet_.start_cdeg = point_angle_cdeg(next_point_); }
    if (!link.suffers(FaultKind::freeze, start_ + when)) { measure(slot, when, world, vehicle); }
    if (slot + 1 == kLd06Points) {
      packet_.end_cdeg = point_angle_cdeg(next_point_);
      const Duration device = config_.device_clock_offset + when;
      packet_.stamp_ms = static_cast<std::uint16_t>(device / 1ms % 30'000);
      link.send(encode(packet_), start_ + when + config_.latency);
    }
    ++next_point_;
  }
}

void Ld06Model::measure(std::size_t slot, Duration when, const World& world,
                        const Vehicle& vehicle) {
  packet_.range_mm[slot] = 0;
  packet_.intensity[slot] = 0;
  const Result<VehicleState> state = vehicle.at(when);
  if (!state) { return; }
  const Pose2d world_T_lidar = state->world_T_base * config_.base_T_lidar;
  const double turned_rad = 2.0 * std::numbers::pi * turn_share(config_, next_point_);
  const double bearing_rad = config_.counter_clockwise ? turned_rad : -turned_rad;
  const double true_m = world.cast({.x_m = world_T_lidar.x_m, .y_m = world_T_lidar.y_m},
                                   world_T_lidar.theta_rad + bearing_rad, config_.max_range_m);
  // Drawn for every beam, so that what one beam sees does not shift the noise of the others.
  const double noise_m = config_.range_sigma_m * random_.gaussian();
  const bool dropped = random_.uniform_f64() < config_.dropout;
  const double range_m = true_m + noise_m;
  if (true_m == 0.0 || dropped || range_m < config_.min_range_m) { return; }
  packet_.range_mm[slot] = static_cast<std::uint16_t>(round_to_i64(1000.0 * range_m, 1, 0xFFFF));
  packet_.intensity[slot] = kHitIntensity;
}

}  // namespace picolo::inline v0::sim
