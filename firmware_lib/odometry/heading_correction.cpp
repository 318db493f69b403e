// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/heading_correction.hpp"

#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {

HeadingCorrection::HeadingCorrection(const HeadingCorrectionConfig& config)
    : config_(config),
      p_aa_(config.scale_sigma * config.scale_sigma),
      p_bb_(config.per_m_sigma_rad * config.per_m_sigma_rad) {}

Pose2d HeadingCorrection::corrected(const Pose2d& odometry_motion) const {
  const Tangent2<double> path = log_se2(odometry_motion);
  return exp_se2(Tangent2<double>{path.x_m, path.y_m, (1.0 + a_) * path.theta_rad + b_ * path.x_m});
}

double HeadingCorrection::variance(const Pose2d& odometry_motion) const {
  const Tangent2<double> path = log_se2(odometry_motion);
  const double ha = path.theta_rad;
  const double hb = path.x_m;
  return ha * ha * p_aa_ + 2.0 * ha * hb * p_ab_ + hb * hb * p_bb_;
}

void HeadingCorrection::update(const Pose2d& odometry_motion, double measured_turn_rad,
                               double variance_rad2) {
  const Tangent2<double> path = log_se2(odometry_motion);
  const double ha = path.theta_rad;
  const double hb = path.x_m;
  p_aa_ += config_.scale_walk * config_.scale_walk;
  p_bb_ += config_.per_m_walk_rad * config_.per_m_walk_rad;

  const double innovation = wrap_angle(measured_turn_rad - ((1.0 + a_) * ha + b_ * hb));
  const double pa = p_aa_ * ha + p_ab_ * hb;
  const double pb = p_ab_ * ha + p_bb_ * hb;
  const double s = ha * pa + hb * pb + variance_rad2;
  if (!(s > 0.0) || innovation * innovation > config_.gate_sigma * config_.gate_sigma * s) {
    return;
  }
  const double ka = pa / s;
  const double kb = pb / s;
  a_ += ka * innovation;
  b_ += kb * innovation;
  p_aa_ -= ka * pa;
  p_ab_ -= ka * pb;
  p_bb_ -= kb * pb;
}

}  // namespace picolo::inline v0
