// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/wheel_script.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::int64_t kCountLimit = std::int64_t{1} << 40;

/// Whole milliseconds, so that movements begin and end between steps of the simulation.
Duration time_for(double amount, double rate) {
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(from_seconds(amount / rate));
  return milliseconds + 1ms;
}

}  // namespace

WheelScript::WheelScript(const WheelScriptConfig& config, const Pose2d& odom_T_start)
    : config_(config), odom_T_base_(odom_T_start) {}

Timestamp WheelScript::go(const Pose2d& odom_T_goal, Timestamp begin) {
  base_ = counts_at(begin);
  moves_ = {};
  const Pose2d way = between(odom_T_base_, odom_T_goal);
  const double distance_m = hypotenuse(way.x_m, way.y_m);
  const bool stays = distance_m < 0.5 * config_.metres_per_count;
  double heading_rad = stays ? 0.0 : arc_tangent2(way.y_m, way.x_m);
  const double behind_rad = wrap_angle(heading_rad + std::numbers::pi);
  const auto turning_rad = [&](double first_rad) {
    return magnitude(first_rad) + magnitude(wrap_angle(way.theta_rad - first_rad));
  };
  const bool backwards = !stays && turning_rad(behind_rad) < turning_rad(heading_rad);
  if (backwards) { heading_rad = behind_rad; }

  add_turn(0, heading_rad, begin);
  add_drive(1, backwards ? -distance_m : distance_m, moves_[0].end + config_.dwell);
  add_turn(2, wrap_angle(odom_T_goal.theta_rad - odom_T_base_.theta_rad),
           moves_[1].end + config_.dwell);
  return moves_[2].end + config_.dwell;
}

void WheelScript::add_turn(std::size_t index, double angle_rad, Timestamp begin) {
  const double rad_per_count = 2.0 * config_.metres_per_count / config_.track_m;
  const std::int64_t counts = round_to_i64(angle_rad / rad_per_count, -kCountLimit, kCountLimit);
  const double turned_rad = static_cast<double>(counts) * rad_per_count;
  const Duration time = time_for(magnitude(turned_rad), config_.max_omega_radps);
  moves_[index] = {.begin = begin, .end = begin + time, .counts = counts, .left_sign = -1};
  odom_T_base_ = odom_T_base_ * Pose2d{.theta_rad = turned_rad};
}

void WheelScript::add_drive(std::size_t index, double distance_m, Timestamp begin) {
  const std::int64_t counts =
      round_to_i64(distance_m / config_.metres_per_count, -kCountLimit, kCountLimit);
  const double driven_m = static_cast<double>(counts) * config_.metres_per_count;
  const Duration time = time_for(magnitude(driven_m), config_.max_speed_mps);
  moves_[index] = {.begin = begin, .end = begin + time, .counts = counts, .left_sign = 1};
  odom_T_base_ = odom_T_base_ * Pose2d{.x_m = driven_m};
}

std::array<std::int64_t, 2> WheelScript::counts_at(Timestamp instant) const {
  std::array<std::int64_t, 2> counts = base_;
  for (const Move& move : moves_) {
    if (instant <= move.begin) { continue; }
    const std::int64_t length = std::max<std::int64_t>((move.end - move.begin).count(), 1);
    const std::int64_t done = std::min((instant - move.begin).count(), length);
    const std::int64_t part = move.counts * done / length;
    counts[0] += move.left_sign * part;
    counts[1] += part;
  }
  return counts;
}

std::array<std::int64_t, 2> WheelScript::rates_at(Timestamp instant) const {
  for (const Move& move : moves_) {
    if (instant <= move.begin || instant >= move.end) { continue; }
    const std::int64_t rate = move.counts * 1'000'000 / (move.end - move.begin).count();
    return {move.left_sign * rate, rate};
  }
  return {};
}

}  // namespace picolo::inline v0::sim
