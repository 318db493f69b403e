// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/motion_uncertainty.hpp"

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"

namespace picolo::inline v0 {

void MotionUncertainty::add(const OdometryNoise& noise, const OdometryStep& step,
                            const Matrix3f& kept) {
  const SinCos<float> yaw = sin_cos(step.map_yaw_rad);
  const float x_m = yaw.cosine * step.motion.x_m - yaw.sine * step.motion.y_m;
  const float y_m = yaw.sine * step.motion.x_m + yaw.cosine * step.motion.y_m;
  const float distance_m = hypotenuse(x_m, y_m);
  const float turn_rad = magnitude(step.motion.theta_rad);
  const float along_x = distance_m > 0.0F ? x_m / distance_m : yaw.cosine;
  const float along_y = distance_m > 0.0F ? y_m / distance_m : yaw.sine;

  // The variance after a way s is walk^2 s^2 / (s + persistence): this step's share of it.
  const float before_m = way_m_;
  way_m_ += distance_m;
  const float persists_m = noise.walk_persists_m;
  const auto variance_m = [persists_m](float way_m) {
    return way_m > 0.0F ? way_m * (way_m / (way_m + persists_m)) : 0.0F;
  };
  const float walked_m = variance_m(way_m_) - variance_m(before_m);

  // Columns: along the way, across it, and the heading, which errs half-way.
  const Matrix3f ways{{along_x, -along_y, -0.5F * y_m,  //
                       along_y, along_x, 0.5F * x_m,    //
                       0.0F, 0.0F, 1.0F}};
  const Matrix3f entering = product(kept, ways);
  const Matrix3f wanders = Matrix3f::diagonal(
      noise.walk_m * noise.walk_m * walked_m, noise.sideways_m * noise.sideways_m * turn_rad,
      noise.heading_walk_rad * noise.heading_walk_rad * walked_m);
  const Matrix3f carried{{1.0F, 0.0F, -y_m,  //
                          0.0F, 1.0F, x_m,   //
                          0.0F, 0.0F, 1.0F}};
  wandering_ = sum(propagate(carried, wandering_), propagate(entering, wanders));

  by_constant_ = product(carried, by_constant_);
  const float drift_rad =
      noise.heading_per_m_rad * distance_m + noise.heading_per_s_rad * step.elapsed_s;
  for (std::size_t row = 0; row < 3; ++row) {
    by_constant_(row, 0) += entering(row, 0) * (noise.scale * distance_m);
    by_constant_(row, 1) += entering(row, 2) * drift_rad;
    by_constant_(row, 2) += entering(row, 2) * (noise.heading_scale * step.motion.theta_rad);
  }
}

void MotionUncertainty::correct(const Matrix3f& kept, const Matrix3f& measurement) {
  wandering_ = sum(propagate(kept, wandering_), measurement);
  by_constant_ = product(kept, by_constant_);
}

Matrix3f MotionUncertainty::covariance() const {
  return sum(wandering_, product(by_constant_, transpose(by_constant_)));
}

}  // namespace picolo::inline v0
