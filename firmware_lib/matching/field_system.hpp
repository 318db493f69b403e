// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From the sums of a walk to normal equations: what Gauss-Newton and Levenberg-Marquardt share.
/// Private to the matchers.
#pragma once

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/matching/field_sums.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/solve/normal_equations.hpp"
#include "pose_steps.hpp"

namespace picolo::inline v0 {

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

/// The robust cost of a pose: squared residuals, each no more than the kernel's width squared (the
/// most also for a point outside of the map), as information, plus the prior's part. Comparable
/// between starts of one request.
inline float cost_of(const FieldSums& sums, const GaussNewtonConfig& config, float reach_m,
                     const MatchRequest& request, const Pose2f& pose) {
  const float kernel = config.kernel_m > 0.0F ? config.kernel_m / reach_m : 1.0F;
  const float outside = static_cast<float>(request.points.size()) - sums.inside;
  const float scan =
      information_scale(sums, config, reach_m) * (sums.robust_squares + outside * kernel * kernel);
  return scan + quadratic_form(request.prior.information, prior_error(request.prior, pose));
}

}  // namespace picolo::inline v0
