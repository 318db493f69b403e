// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Steps, limits and priors: what every iterative matcher shares. Private to the matchers.
#pragma once

#include <array>
#include <cstddef>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/solve/normal_equations.hpp"

namespace picolo::inline v0 {

inline constexpr float kUnknownVariance = 1e3F;

/// The other outcomes hand the start back.
inline bool keeps_pose(MatchOutcome outcome) {
  return outcome == MatchOutcome::converged || outcome == MatchOutcome::iteration_limit ||
         outcome == MatchOutcome::degenerate;
}

inline bool is_prior(const PosePrior& prior) {
  return prior.information != Matrix3f{};
}

inline std::array<float, 3> prior_error(const PosePrior& prior, const Pose2f& pose) {
  return {prior.pose.x_m - pose.x_m, prior.pose.y_m - pose.y_m,
          wrap_angle(prior.pose.theta_rad - pose.theta_rad)};
}

inline void add_prior(const PosePrior& prior, const Pose2f& pose, NormalEquations3& system) {
  const std::array<float, 3> error = prior_error(prior, pose);
  system.h = sum(system.h, prior.information);
  for (std::size_t row = 0; row < 3; ++row) {
    system.b[row] += (prior.information(row, 0) * error[0] + prior.information(row, 1) * error[1]) +
                     prior.information(row, 2) * error[2];
  }
}

inline float quadratic_form(const Matrix3f& m, const std::array<float, 3>& v) {
  float total = 0.0F;
  for (std::size_t row = 0; row < 3; ++row) {
    total += v[row] * ((m(row, 0) * v[0] + m(row, 1) * v[1]) + m(row, 2) * v[2]);
  }
  return total;
}

inline Pose2f moved_by(const Pose2f& pose, const std::array<float, 3>& step) {
  return {pose.x_m + step[0], pose.y_m + step[1], wrap_angle(pose.theta_rad + step[2])};
}

/// Shortens a step that is too long in translation or rotation; one factor for all, so that its
/// direction stays.
inline void shorten(float max_m, float max_rad, std::array<float, 3>& step) {
  const float length_m = hypotenuse(step[0], step[1]);
  const float turn_rad = magnitude(step[2]);
  float factor = 1.0F;
  if (length_m > max_m) { factor = max_m / length_m; }
  if (turn_rad * factor > max_rad) { factor = max_rad / turn_rad; }
  for (float& component : step) { component *= factor; }
}

inline bool is_below(float limit_m, float limit_rad, const std::array<float, 3>& step) {
  const float turn_rad = magnitude(step[2]);
  return hypotenuse(step[0], step[1]) < limit_m && turn_rad < limit_rad;
}

inline bool is_beyond(float limit_m, float limit_rad, const Pose2f& start, const Pose2f& pose) {
  const float turned_rad = wrap_angle(pose.theta_rad - start.theta_rad);
  return hypotenuse(pose.x_m - start.x_m, pose.y_m - start.y_m) > limit_m ||
         turned_rad > limit_rad || turned_rad < -limit_rad;
}

}  // namespace picolo::inline v0
