// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/vehicle.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr double kStepS = 1e-3;
constexpr std::uint64_t kStream = 11;

double mix(double from, double to, double share) {
  return from + (to - from) * share;
}

}  // namespace

Vehicle::Vehicle(const VehicleConfig& config, const Pose2d& world_T_start, std::uint64_t seed)
    : config_(config), random_(seed, kStream) {
  newest_.world_T_base = world_T_start;
  history_[0] = newest_;
}

void Vehicle::step(const DriveCommand& command) {
  // Slip is an Ornstein-Uhlenbeck process: correlated in time, bounded in the mean.
  const double forget = kStepS / config_.slip_time_constant_s;
  const double kick = config_.slip_sigma * square_root(2.0 * forget);
  for (double& slip : slip_) { slip += kick * random_.gaussian() - forget * slip; }

  VehicleState& s = newest_;
  s.acceleration_mps2 = (command.speed_mps - s.speed_mps) / kStepS;
  s.alpha_radps2 = (command.omega_radps - s.omega_radps) / kStepS;
  s.speed_mps = command.speed_mps;
  s.omega_radps = command.omega_radps;
  s.lateral_mps = -config_.scrub_s * command.speed_mps * command.omega_radps;
  s.world_T_base = s.world_T_base * exp_se2(Tangent2<double>{.x_m = s.speed_mps * kStepS,
                                                             .y_m = s.lateral_mps * kStepS,
                                                             .theta_rad = s.omega_radps * kStepS});

  const double half_track_m = 0.5 * config_.track_m;
  const std::array<double, 2> ground_mps{s.speed_mps - s.omega_radps * half_track_m,
                                         s.speed_mps + s.omega_radps * half_track_m};
  const std::array<double, 2> radius_m{config_.radius_left_m, config_.radius_right_m};
  for (std::size_t wheel = 0; wheel < 2; ++wheel) {
    s.wheel_rate_radps[wheel] = ground_mps[wheel] / radius_m[wheel] * (1.0 + slip_[wheel]);
    s.wheel_angle_rad[wheel] += s.wheel_rate_radps[wheel] * kStepS;
  }
  s.elapsed += kStep;
  history_[static_cast<std::size_t>(s.elapsed / kStep) % kRemembered] = s;
}

Result<VehicleState> Vehicle::at(Duration elapsed) const {
  if (elapsed < Duration{0} || elapsed > newest_.elapsed) { return Status::out_of_range; }
  const auto index = static_cast<std::size_t>(elapsed / kStep);
  if (static_cast<std::size_t>(newest_.elapsed / kStep) - index >= kRemembered) {
    return Status::out_of_range;
  }
  const VehicleState& from = history_[index % kRemembered];
  if (elapsed == from.elapsed) { return from; }
  const VehicleState& to = history_[(index + 1) % kRemembered];
  const double share = to_seconds_f64(elapsed - from.elapsed) / kStepS;
  VehicleState state = to;
  state.elapsed = elapsed;
  state.world_T_base = interpolate(from.world_T_base, to.world_T_base, share);
  for (std::size_t wheel = 0; wheel < 2; ++wheel) {
    state.wheel_angle_rad[wheel] =
        mix(from.wheel_angle_rad[wheel], to.wheel_angle_rad[wheel], share);
  }
  return state;
}

}  // namespace picolo::inline v0::sim
