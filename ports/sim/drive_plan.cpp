// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/drive_plan.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr double kStepS = 1e-3;
constexpr double kTargetStepM = 0.005;
constexpr int kMaxTargetSteps = 200;
constexpr double kSteeringGainPerS = 2.0;
constexpr double kStandingTurnRad = 0.8;  ///< beyond this heading error it turns on the spot
constexpr double kArrivedM = 0.02;

double toward(double from, double to, double max_change) {
  return from + std::clamp(to - from, -max_change, max_change);
}

double distance(const Point2d& a, const Point2d& b) {
  return hypotenuse(a.x_m - b.x_m, a.y_m - b.y_m);
}

}  // namespace

DrivePlan::DrivePlan(const DriveLimits& limits, const Route& route, bool closed,
                     const TwistScript& script)
    : limits_(limits), route_(route), script_(script), closed_(closed) {
  if (!route_.empty()) { target_ = route_[0]; }
}

DriveCommand DrivePlan::next(const VehicleState& state) {
  const DriveCommand goal = wanted(state);
  last_.speed_mps = toward(last_.speed_mps, goal.speed_mps, limits_.max_acceleration_mps2 * kStepS);
  last_.omega_radps =
      toward(last_.omega_radps, goal.omega_radps, limits_.max_alpha_radps2 * kStepS);
  return last_;
}

DriveCommand DrivePlan::wanted(const VehicleState& state) {
  if (state.elapsed < limits_.stand_at_start || finished_) { return {}; }
  const DriveCommand goal = script_.empty() ? chase(state) : recite(state.elapsed);
  return {.speed_mps = std::clamp(goal.speed_mps, -limits_.max_speed_mps, limits_.max_speed_mps),
          .omega_radps =
              std::clamp(goal.omega_radps, -limits_.max_omega_radps, limits_.max_omega_radps)};
}

DriveCommand DrivePlan::chase(const VehicleState& state) {
  const Point2d position{.x_m = state.world_T_base.x_m, .y_m = state.world_T_base.y_m};
  if (route_.size() < 2) {
    finished_ = true;
    return {};
  }
  advance_target(position);
  const double gap_m = distance(position, target_);
  const bool at_last_point = !closed_ && leg_ + 1 == route_.size();
  if (at_last_point && gap_m < kArrivedM) {
    finished_ = true;
    return {};
  }
  const double bearing_rad = arc_tangent2(target_.y_m - position.y_m, target_.x_m - position.x_m);
  const double error_rad = wrap_angle(bearing_rad - state.world_T_base.theta_rad);
  const double slow_down = std::clamp(1.0 - magnitude(error_rad) / kStandingTurnRad, 0.0, 1.0);
  const double can_stop_mps = square_root(limits_.max_acceleration_mps2 * gap_m);
  const double speed_mps = limits_.max_speed_mps * slow_down;
  return {.speed_mps = at_last_point ? std::min(speed_mps, can_stop_mps) : speed_mps,
          .omega_radps = kSteeringGainPerS * error_rad};
}

DriveCommand DrivePlan::recite(Duration elapsed) {
  Duration end = limits_.stand_at_start;
  for (const TwistPiece& piece : script_) {
    end += piece.duration;
    if (elapsed < end) { return {.speed_mps = piece.speed_mps, .omega_radps = piece.omega_radps}; }
  }
  finished_ = last_.speed_mps == 0.0 && last_.omega_radps == 0.0;
  return {};
}

/// Bounded; what is left is run in the next call.
void DrivePlan::advance_target(const Point2d& position) {
  for (int step = 0; step < kMaxTargetSteps; ++step) {
    if (distance(position, target_) >= limits_.look_ahead_m) { return; }
    if (!closed_ && leg_ + 1 == route_.size()) { return; }
    const Point2d from = route_[leg_];
    const Point2d to = route_[(leg_ + 1) % route_.size()];
    const double length_m = distance(from, to);
    leg_done_m_ += kTargetStepM;
    if (leg_done_m_ >= length_m) {
      leg_done_m_ = 0.0;
      leg_ = closed_ ? (leg_ + 1) % route_.size() : leg_ + 1;
      target_ = to;
      continue;
    }
    const double share = leg_done_m_ / length_m;
    target_ = {.x_m = from.x_m + share * (to.x_m - from.x_m),
               .y_m = from.y_m + share * (to.y_m - from.y_m)};
  }
}

}  // namespace picolo::inline v0::sim
