// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the map says of single points of the sweep.

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::inline v0 {
namespace {

/// A prediction is surely better than so many of its sigmas.
constexpr float kSureSigmas = 3.2F;

/// Largest over smallest eigenvalue of a scan's information: beyond it little but corners speaks of
/// one direction.
constexpr float kWeakCondition = 20.0F;

}  // namespace

LocaliserCore::Sighting LocaliserCore::sight(const Pose2f& pose, const SinCos<float>& yaw,
                                             std::size_t k) const {
  const float x_m = sweep_.points.x_m[k];
  const float y_m = sweep_.points.y_m[k];
  const Point2f p{pose.x_m + (yaw.cosine * x_m - yaw.sine * y_m),
                  pose.y_m + (yaw.sine * x_m + yaw.cosine * y_m)};
  const DistanceFieldView field = fine_.field();
  const FieldSample at = sample_field(field, p.x_m, p.y_m);
  const float residual_m = (1.0F - at.value) * field.reach_m;
  if (!(at.inside > 0.0F) || residual_m <= config_.fine.inlier_m) { return {at, Ground::other}; }
  const std::int32_t column = floor_to_i32(p.x_m * field.cells_per_m, 0, field.width - 1);
  const std::int32_t row = floor_to_i32(p.y_m * field.cells_per_m, 0, field.height - 1);
  const std::int8_t log_odds =
      fine_.occupancy()[static_cast<std::size_t>(row * field.width + column)];
  if (log_odds == 0) { return {at, Ground::unseen}; }
  return {at, log_odds < 0 ? Ground::clear : Ground::other};
}

/// Points in cells that nobody has seen yet tell neither for nor against the pose; those in cells
/// seen free do, against it.
float LocaliserCore::agreement_of(const MatchReport& report) const {
  const SinCos<float> yaw = sin_cos(report.pose.theta_rad);
  int against = 0;
  for (std::size_t k = 0; k < sweep_.points.size(); ++k) {
    against += sight(report.pose, yaw, k).ground == Ground::clear ? 1 : 0;
  }
  const float in_favour = report.inlier_share * static_cast<float>(sweep_.points.size());
  const float known = in_favour + static_cast<float>(against);
  return known > 0.0F ? in_favour / known : 0.0F;
}

/// A corner that is no inlier, where the map knows nothing, is new: nothing there is what it should
/// be drawn to. That is so where the pose is not in doubt altogether and its prediction better than
/// the inlier distance (across; a turn moves far corners further), so up to 0.09 m and 8 deg a
/// sweep. It matters where the last scan left a direction to hardly more than such corners: in a
/// corridor they drag the pose along.
bool LocaliserCore::new_corners_mislead() const {
  return !unverified_ && kSureSigmas * translation_sigma_m_ <= config_.fine.inlier_m &&
         report_.conditioning.condition > kWeakCondition;
}

/// A point whose surface runs along the field's slope moves freely, near the prediction.
void LocaliserCore::release_new_corners() {
  const Pose2f& pose = request_.prior.pose;
  const SinCos<float> yaw = sin_cos(pose.theta_rad);
  for (std::size_t k = 0; k < sweep_.points.along_x.size(); ++k) {
    if (surfaces_.along_x[k] != 0 || surfaces_.along_y[k] != 0) { continue; }
    const Sighting seen = sight(pose, yaw, k);
    const float x = seen.at.slope_x_per_m;
    const float y = seen.at.slope_y_per_m;
    const float slope = hypotenuse(x, y);
    if (seen.ground != Ground::unseen || !(slope > 0.0F)) { continue; }
    const auto to_step = [slope](float component) {
      return static_cast<std::int8_t>(round_to_i32(127.0F / slope * component, -127, 127));
    };
    surfaces_.along_x[k] = to_step(yaw.cosine * x + yaw.sine * y);
    surfaces_.along_y[k] = to_step(yaw.cosine * y - yaw.sine * x);
  }
}

}  // namespace picolo::inline v0
