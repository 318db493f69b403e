// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From the sums of a walk to normal equations: what Gauss-Newton and Levenberg-Marquardt share.
/// Private to the matchers.
#pragma once

#include <algorithm>
#include <array>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/field_sums.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/solve/normal_equations.hpp"

namespace picolo::inline v0 {

inline constexpr float kUnknownVariance = 1e3F;

inline FieldWalk walk_at(const GaussNewtonConfig& config, float reach_m, const Pose2f& pose) {
  const SinCos<float> yaw = sin_cos(pose.theta_rad);
  const float kernel = config.kernel_m / reach_m;
  return {.x_m = pose.x_m,
          .y_m = pose.y_m,
          .sine = yaw.sine,
          .cosine = yaw.cosine,
          .inverse_kernel_squared = kernel > 0.0F ? 1.0F / (kernel * kernel) : 0.0F,
          .inlier_residual = config.inlier_m / reach_m};
}

/// From unit-free sums to an information: residuals in metres over sigma, at most
/// `effective_points` independent ones.
inline float information_scale(const FieldSums& sums, const GaussNewtonConfig& config,
                               float reach_m) {
  const float per_residual = (reach_m / config.sigma_m) * (reach_m / config.sigma_m);
  return per_residual * std::min(1.0F, config.effective_points / sums.inside);
}

inline NormalEquations3 scaled_system(const FieldSums& sums, float s) {
  return {{{s * sums.xx, s * sums.xy, s * sums.xt, s * sums.xy, s * sums.yy, s * sums.yt,
            s * sums.xt, s * sums.yt, s * sums.tt}},
          {s * sums.bx, s * sums.by, s * sums.bt}};
}

inline void add_prior(const PosePrior& prior, const Pose2f& pose, NormalEquations3& system) {
  const std::array<float, 3> error{prior.pose.x_m - pose.x_m, prior.pose.y_m - pose.y_m,
                                   wrap_angle(prior.pose.theta_rad - pose.theta_rad)};
  system.h = sum(system.h, prior.information);
  for (std::size_t row = 0; row < 3; ++row) {
    system.b[row] += (prior.information(row, 0) * error[0] + prior.information(row, 1) * error[1]) +
                     prior.information(row, 2) * error[2];
  }
}

/// Shortens a step that is too long in translation or rotation; one factor for all, so that its
/// direction stays.
inline void limit_step(const GaussNewtonConfig& config, std::array<float, 3>& step) {
  const float length_m = hypotenuse(step[0], step[1]);
  const float turn_rad = step[2] < 0.0F ? -step[2] : step[2];
  float factor = 1.0F;
  if (length_m > config.max_step_m) { factor = config.max_step_m / length_m; }
  if (turn_rad * factor > config.max_step_rad) { factor = config.max_step_rad / turn_rad; }
  for (float& component : step) { component *= factor; }
}

inline bool is_prior(const PosePrior& prior) {
  return prior.information != Matrix3f{};
}

}  // namespace picolo::inline v0
