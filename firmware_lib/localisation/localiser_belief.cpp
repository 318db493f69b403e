// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the localiser believes before a match, of the motion, and after it, of the fit.

#include <algorithm>
#include <array>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kUnknownVariance = 1e3F;  // m^2, rad^2

void add_square(const std::array<float, 3>& gradient, Matrix3f& sum_of_squares) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      sum_of_squares(row, column) += gradient[row] * gradient[column];
    }
  }
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
  float still =
      square(noise.translation_base_m) + square(noise.translation_per_rad_m) * squared_turn;
  if (guessed_) { still += square(noise.guessed_translation_m); }
  const float along = still + square(noise.translation_per_m) * squared_distance;
  float turn = square(noise.rotation_base_rad) +
               square(noise.rotation_per_m_rad) * squared_distance +
               square(noise.rotation_per_rad) * squared_turn;
  if (config_.learn_heading) { turn += static_cast<float>(heading_.variance(motion)); }
  if (guessed_) { turn += square(noise.guessed_rotation_rad); }
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

/// Of all points, should the walls move away from the vehicle: the gradient for 1 m and points of
/// unit information.
std::array<float, 3> LocaliserCore::receding_gradient() const {
  const PointsView& points = sweep_.points;
  std::array<float, 3> gradient{};
  if (points.along_x.size() != points.size()) { return gradient; }
  const SinCos<float> yaw = sin_cos(report_.pose.theta_rad);
  constexpr std::size_t kStride = 2;  // half of the points say as much at half the cost
  constexpr float kStep = static_cast<float>(kStride) / 127.0F;
  for (std::size_t k = 0; k < points.size(); k += kStride) {
    const float x = kStep * static_cast<float>(points.along_x[k]);
    const float y = kStep * static_cast<float>(points.along_y[k]);
    // Across the surface, outwards, in base; theta is the same in the axes of the map.
    const float outwards = points.y_m[k] * x - points.x_m[k] * y < 0.0F ? -1.0F : 1.0F;
    const float normal_x = -outwards * y;
    const float normal_y = outwards * x;
    gradient[0] += yaw.cosine * normal_x - yaw.sine * normal_y;
    gradient[1] += yaw.sine * normal_x + yaw.cosine * normal_y;
    gradient[2] += normal_y * points.x_m[k] - normal_x * points.y_m[k];
  }
  return gradient;
}

/// The match weighs prediction and scan by their informations: of the prediction's error `kept`
/// remains, C * prior; the scan's part errs as the residuals say, not as the weights do: with H the
/// scan's information and the variance of its gradient k H, by k C H C = k (1 - kept) C.
void LocaliserCore::update_uncertainty(const Matrix3f& cell_gradients) {
  const UncertaintyConfig& config = config_.uncertainty;
  const OdometryStep step{
      .map_yaw_rad = static_cast<float>(accepted_map_T_base_.theta_rad),
      .motion = to_f32(between(accepted_odom_T_base_, sweep_.odom_T_base)),
      .elapsed_s = static_cast<float>(to_seconds_f64(reference_ - accepted_reference_))};
  const Conditioning& conditioning = report_.conditioning;
  const Matrix3f& prior = report_prior_;
  const NormalEquations3 constrained = observable_part({report_.scan_information, {}}, conditioning,
                                                       report_.length_m, config.max_condition);
  const Matrix3f fused = covariance_of(sum(constrained.h, prior), kUnknownVariance);
  const Matrix3f kept = product(fused, prior);
  Matrix3f scan_share = Matrix3f::identity();
  for (std::size_t i = 0; i < 9; ++i) { scan_share.elements[i] -= kept.elements[i]; }
  const float points = static_cast<float>(std::max(1, report_.points));
  // Of a point on a wall that is sharp in the field.
  const float information =
      std::min(1.0F, config_.fine.effective_points / points) / square(config_.fine.sigma_m);
  const float factor = config.residual_factor * report_.residual_variance_m2 * information;
  const Matrix3f share = product(scan_share, fused);
  const Matrix3f scan = scaled(sum(share, transpose(share)), 0.5F * factor);

  const Matrix3f cells = propagate(share, scaled(cell_gradients, square(information)));

  if (!localises_only_) { in_map_.start({}); }
  in_map_.add(config.odometry, step);
  if (!with_odometry_) {
    in_map_.correct(Matrix3f::identity(),
                    Matrix3f::diagonal(square(config_.noise.blind_translation_m),
                                       square(config_.noise.blind_translation_m),
                                       square(config_.noise.blind_rotation_rad)));
  }
  in_map_.correct(kept, scan);
  if (localises_only_) {
    in_map_error_ = cells;
    return;
  }

  drift_.add(config.odometry, step, kept);
  const float way_m = hypotenuse(step.motion.x_m, step.motion.y_m);
  const float added =
      (counters_.matched == 1 ? config.founding_factor : 0.0F) + config.renewal_per_m * way_m;
  const float unit = (report_.scan_information(0, 0) + report_.scan_information(1, 1)) / points;
  Matrix3f receding{};
  add_square(receding_gradient(), receding);
  const float receded = square(unit * config.receding_m) * way_m;
  drift_.correct(Matrix3f::identity(),
                 sum(sum(scaled(scan, added), cells), propagate(fused, scaled(receding, receded))));
}

}  // namespace picolo::inline v0
