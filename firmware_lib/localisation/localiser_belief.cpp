// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the localiser believes before a match, of the motion, and after it, of the fit.

#include <algorithm>
#include <span>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::inline v0 {
namespace {

float square(float x) {
  return x * x;
}

}  // namespace

/// In the base frame at the end of the motion. An error of the heading, spread over the way,
/// carries the end of the way sideways: the two are correlated, and a wheeled vehicle hardly moves
/// sideways otherwise.
Matrix3f LocaliserCore::motion_covariance(const Pose2d& motion) const {
  const PredictionNoise& noise = config_.noise;
  const Pose2f back = to_f32(inverse(motion));  // the way in the axes of its end
  const float squared_distance = square(back.x_m) + square(back.y_m);
  const float squared_turn = square(back.theta_rad);
  const float still =
      square(noise.translation_base_m) + square(noise.translation_per_rad_m) * squared_turn;
  const float along = still + square(noise.translation_per_m) * squared_distance;
  float turn = square(noise.rotation_base_rad) +
               square(noise.rotation_per_m_rad) * squared_distance +
               square(noise.rotation_per_rad) * squared_turn;
  if (config_.learn_heading) { turn += static_cast<float>(heading_.variance(motion)); }
  const float across = still + turn * squared_distance / 3.0F;
  Matrix3f covariance = Matrix3f::diagonal(still, still, turn);
  if (squared_distance > 0.0F) {
    const float xx = square(back.x_m) / squared_distance;
    const float xy = back.x_m * back.y_m / squared_distance;
    const float yy = square(back.y_m) / squared_distance;
    covariance(0, 0) = along * xx + across * yy;
    covariance(0, 1) = (along - across) * xy;
    covariance(1, 1) = along * yy + across * xx;
    covariance(1, 0) = covariance(0, 1);
  }
  // Half of the turn's error, times the way: the end moves to the left of the way by it.
  covariance(0, 2) = 0.5F * turn * back.y_m;
  covariance(1, 2) = -0.5F * turn * back.x_m;
  covariance(2, 0) = covariance(0, 2);
  covariance(2, 1) = covariance(1, 2);
  return covariance;
}

/// Points in cells that nobody has seen yet tell neither for nor against the pose; those in cells
/// seen free do, against it.
float LocaliserCore::agreement_of(const MatchReport& report) const {
  const SinCos<float> yaw = sin_cos(report.pose.theta_rad);
  const DistanceFieldView field = fine_.field();
  const std::span<const std::int8_t> occupancy = fine_.occupancy();
  const float near = config_.fine.inlier_m / field.reach_m;
  int against = 0;
  for (std::size_t k = 0; k < sweep_.points.size(); ++k) {
    const float x_m = sweep_.points.x_m[k];
    const float y_m = sweep_.points.y_m[k];
    const Point2f p{report.pose.x_m + (yaw.cosine * x_m - yaw.sine * y_m),
                    report.pose.y_m + (yaw.sine * x_m + yaw.cosine * y_m)};
    const FieldSample at = sample_field(field, p.x_m, p.y_m);
    if (!(at.inside > 0.0F) || 1.0F - at.value <= near) { continue; }
    const std::int32_t column = floor_to_i32(p.x_m * field.cells_per_m, 0, field.width - 1);
    const std::int32_t row = floor_to_i32(p.y_m * field.cells_per_m, 0, field.height - 1);
    against += occupancy[static_cast<std::size_t>(row * field.width + column)] < 0 ? 1 : 0;
  }
  const float in_favour = report.inlier_share * static_cast<float>(sweep_.points.size());
  const float known = in_favour + static_cast<float>(against);
  return known > 0.0F ? in_favour / known : 0.0F;
}

}  // namespace picolo::inline v0
