// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the localiser believes before a match, of the motion, and after it, of the fit.

#include <algorithm>
#include <array>
#include <span>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
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

/// A wall along a row of cells lies anywhere within it, and all its points err together by what a
/// cell is wide: the gradient's covariance from that, over the cell's variance, for points of unit
/// information. Walls of four sides; those oblique to the cells are stairs, which even out. And the
/// same for all walls together, should they move away from the vehicle.
LocaliserCore::WallErrors LocaliserCore::wall_errors() const {
  const PointsView& points = sweep_.points;
  WallErrors errors;
  if (points.along_x.size() != points.size()) { return errors; }
  const SinCos<float> yaw = sin_cos(report_.pose.theta_rad);
  constexpr float kStep = 1.0F / 127.0F;
  constexpr std::size_t kStride = 2;  // half of the points say as much at half the cost
  const float per_square = 1.0F / square(config_.uncertainty.aligned_rad);
  std::array<std::array<float, 3>, 4> sides{};  // in the map: left, right, below, above
  std::array<float, 3> outward{};
  for (std::size_t k = 0; k < points.size(); k += kStride) {
    const float x = kStep * static_cast<float>(points.along_x[k]);
    const float y = kStep * static_cast<float>(points.along_y[k]);
    if (x == 0.0F && y == 0.0F) { continue; }
    const float along_x = yaw.cosine * x - yaw.sine * y;
    const float along_y = yaw.sine * x + yaw.cosine * y;
    const float arm_x = yaw.cosine * points.x_m[k] - yaw.sine * points.y_m[k];
    const float arm_y = yaw.sine * points.x_m[k] + yaw.cosine * points.y_m[k];
    const bool upright = square(along_x) < square(along_y);
    const float oblique = 1.0F + square(upright ? along_x : along_y) * per_square;
    const float weight = static_cast<float>(kStride) / oblique;
    // The normal, towards growing x of upright walls, y of others.
    const float turned = (upright ? along_y : -along_x) < 0.0F ? -weight : weight;
    const float normal_x = turned * along_y;
    const float normal_y = -turned * along_x;
    std::array<float, 3>& side =
        upright ? sides[arm_x < 0.0F ? 0 : 1] : sides[arm_y < 0.0F ? 2 : 3];
    const float arm = normal_x * arm_x + normal_y * arm_y;
    const float outwards = arm < 0.0F ? -oblique : oblique;
    const std::array<float, 3> gradient{normal_x, normal_y, normal_y * arm_x - normal_x * arm_y};
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] += gradient[i];
      outward[i] += outwards * gradient[i];
    }
  }
  for (const std::array<float, 3>& side : sides) { add_square(side, errors.aligned); }
  add_square(outward, errors.receding);
  return errors;
}

/// The match weighs prediction and scan by their informations: of the prediction's error `kept`
/// remains, C * prior; the scan's part errs as the residuals say, not as the weights do: with H the
/// scan's information and the variance of its gradient k H, by k C H C = k (1 - kept) C.
void LocaliserCore::update_uncertainty() {
  const UncertaintyConfig& config = config_.uncertainty;
  const OdometryStep step{
      .map_yaw_rad = static_cast<float>(accepted_map_T_base_.theta_rad),
      .motion = to_f32(between(accepted_odom_T_base_, sweep_.odom_T_base)),
      .elapsed_s = static_cast<float>(to_seconds_f64(reference_ - accepted_reference_))};
  const Conditioning conditioning = conditioning_of(report_.scan_information, report_.length_m);
  const Matrix3f& prior = report_prior_;
  const NormalEquations3 constrained = observable_part({report_.scan_information, {}}, conditioning,
                                                       report_.length_m, config.max_condition);
  const Matrix3f fused = covariance_of(sum(constrained.h, prior), kUnknownVariance);
  const Matrix3f kept = product(fused, prior);
  Matrix3f scan_share = Matrix3f::identity();
  for (std::size_t i = 0; i < 9; ++i) { scan_share.elements[i] -= kept.elements[i]; }
  const float points = static_cast<float>(std::max(1, report_.points));
  const float factor = config.residual_factor * report_.residual_variance_m2 /
                       square(config_.fine.sigma_m) *
                       std::min(1.0F, config_.fine.effective_points / points);
  const Matrix3f share = product(scan_share, fused);
  const Matrix3f scan = scaled(sum(share, transpose(share)), 0.5F * factor);

  const float cell_variance = square(fine_.config().cell_m) / 12.0F;
  const float unit = (report_.scan_information(0, 0) + report_.scan_information(1, 1)) / points;
  const WallErrors walls = wall_errors();
  const Matrix3f stairs = propagate(fused, scaled(walls.aligned, unit * unit * cell_variance));

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
    in_map_error_ = stairs;
    return;
  }

  drift_.add(config.odometry, step, kept);
  const float way_m = hypotenuse(step.motion.x_m, step.motion.y_m);
  const float added =
      (counters_.matched == 1 ? config.founding_factor : 0.0F) + config.renewal_per_m * way_m;
  const float receding = square(unit * config.receding_m) * way_m;
  drift_.correct(Matrix3f::identity(),
                 sum(scaled(scan, added), propagate(fused, scaled(walls.receding, receding))));
  if (counters_.matched == 1) { drift_.correct(Matrix3f::identity(), stairs); }
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
