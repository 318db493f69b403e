// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/icp.hpp"

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "pose_steps.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kNoPartner = -1.0F;

struct Nearest {
  std::size_t index = 0;
  float squared_m2 = kNoPartner;
};

/// From the place of x in the sorted list outwards, until the list is further away in x alone.
Nearest nearest_of(const PointsView& points, std::span<const std::uint16_t> by_x, Point2f p,
                   float max_squared_m2) {
  const auto first_not_left =
      std::lower_bound(by_x.begin(), by_x.end(), p.x_m,
                       [&](std::uint16_t index, float x_m) { return points.x_m[index] < x_m; });
  Nearest nearest;
  float limit = max_squared_m2;
  const auto consider = [&](std::uint16_t index) {
    const float dx = points.x_m[index] - p.x_m;
    const float dy = points.y_m[index] - p.y_m;
    if (dx * dx > limit) { return false; }
    const float squared = dx * dx + dy * dy;
    const bool closer = squared < limit;
    const bool first = squared == limit && (nearest.squared_m2 < 0.0F || index < nearest.index);
    if (closer || first) {
      nearest = {index, squared};
      limit = squared;
    }
    return true;
  };
  for (auto it = first_not_left; it != by_x.end(); ++it) {
    if (!consider(*it)) { break; }
  }
  for (auto it = first_not_left; it != by_x.begin();) {
    --it;
    if (!consider(*it)) { break; }
  }
  return nearest;
}

}  // namespace

void IcpMatcherCore::begin(const PointsView& reference, const MatchRequest& request) {
  reference_ = reference;
  request_ = request;
  report_ = {};
  report_.pose = request.start;
  report_.covariance = Matrix3f::diagonal(kUnknownVariance, kUnknownVariance, kUnknownVariance);
  done_ = false;
  scan_count_ = std::min(request.points.size(), storage_.partner.size());
  reference_count_ = 0;
  const std::size_t all = std::min(reference.size(), storage_.by_x.size());
  for (std::size_t i = 0; i < all; ++i) {
    if (!is_finite(reference.x_m[i]) || !is_finite(reference.y_m[i])) { continue; }
    storage_.by_x[reference_count_] = static_cast<std::uint16_t>(i);
    ++reference_count_;
  }
  const auto by_x = storage_.by_x.first(reference_count_);
  std::sort(by_x.begin(), by_x.end(), [&](std::uint16_t a, std::uint16_t b) {
    return reference.x_m[a] < reference.x_m[b] || (reference.x_m[a] == reference.x_m[b] && a < b);
  });
  const auto needed = static_cast<std::size_t>(config_.min_pairs);
  if (scan_count_ < needed || reference_count_ < needed) { finish(MatchOutcome::too_few_points); }
}

bool IcpMatcherCore::finish(MatchOutcome outcome) {
  report_.outcome = outcome;
  done_ = true;
  if (!keeps_pose(outcome)) { report_.pose = request_.start; }
  return true;
}

std::size_t IcpMatcherCore::find_partners() {
  const SinCos<float> yaw = sin_cos(report_.pose.theta_rad);
  const auto by_x = storage_.by_x.first(reference_count_);
  const float limit = config_.max_pair_m * config_.max_pair_m;
  std::size_t pairs = 0;
  for (std::size_t k = 0; k < scan_count_; ++k) {
    const float x_m = request_.points.x_m[k];
    const float y_m = request_.points.y_m[k];
    const Point2f p{report_.pose.x_m + (yaw.cosine * x_m - yaw.sine * y_m),
                    report_.pose.y_m + (yaw.sine * x_m + yaw.cosine * y_m)};
    Nearest nearest;
    if (is_finite(p.x_m) && is_finite(p.y_m)) { nearest = nearest_of(reference_, by_x, p, limit); }
    storage_.partner[k] = static_cast<std::uint16_t>(nearest.index);
    storage_.squared_m2[k] = nearest.squared_m2;
    if (nearest.squared_m2 >= 0.0F) {
      storage_.sorted_m2[pairs] = nearest.squared_m2;
      ++pairs;
    }
  }
  return pairs;
}

/// The largest squared distance that stays.
float IcpMatcherCore::trim_limit(std::size_t pairs) {
  const std::int32_t keep = round_to_i32(config_.keep_share * static_cast<float>(pairs), 1,
                                         static_cast<std::int32_t>(pairs));
  const auto sorted = storage_.sorted_m2.first(pairs);
  std::nth_element(sorted.begin(), sorted.begin() + (keep - 1), sorted.end());
  return sorted[static_cast<std::size_t>(keep - 1)];
}

// In the plane Arun's rotation is atan2 of the cross and the dot products: always a rotation, never
// a reflection.
bool IcpMatcherCore::improve(float limit_m2, Pose2f& pose) {
  float count = 0.0F;
  Point2f scan_mean{};
  Point2f reference_mean{};
  float distance_m = 0.0F;
  const auto kept = [&](std::size_t k) {
    return storage_.squared_m2[k] >= 0.0F && storage_.squared_m2[k] <= limit_m2;
  };
  for (std::size_t k = 0; k < scan_count_; ++k) {
    if (!kept(k)) { continue; }
    count += 1.0F;
    scan_mean.x_m += request_.points.x_m[k];
    scan_mean.y_m += request_.points.y_m[k];
    reference_mean.x_m += reference_.x_m[storage_.partner[k]];
    reference_mean.y_m += reference_.y_m[storage_.partner[k]];
    distance_m += square_root(storage_.squared_m2[k]);
  }
  scan_mean = {scan_mean.x_m / count, scan_mean.y_m / count};
  reference_mean = {reference_mean.x_m / count, reference_mean.y_m / count};
  float dots = 0.0F;
  float crosses = 0.0F;
  float spread = 0.0F;
  for (std::size_t k = 0; k < scan_count_; ++k) {
    if (!kept(k)) { continue; }
    const float sx = request_.points.x_m[k] - scan_mean.x_m;
    const float sy = request_.points.y_m[k] - scan_mean.y_m;
    const float rx = reference_.x_m[storage_.partner[k]] - reference_mean.x_m;
    const float ry = reference_.y_m[storage_.partner[k]] - reference_mean.y_m;
    dots += sx * rx + sy * ry;
    crosses += sx * ry - sy * rx;
    spread += sx * sx + sy * sy;
  }
  report_.points = round_to_i32(count, 0, 1 << 24);
  report_.mean_residual_m = distance_m / count;
  report_.inlier_share = count / static_cast<float>(request_.points.size());
  if (dots == 0.0F && crosses == 0.0F) { return false; }
  const float theta_rad = arc_tangent2(crosses, dots);
  const SinCos<float> yaw = sin_cos(theta_rad);
  const Point2f arm{yaw.cosine * scan_mean.x_m - yaw.sine * scan_mean.y_m,
                    yaw.sine * scan_mean.x_m + yaw.cosine * scan_mean.y_m};
  pose = {reference_mean.x_m - arm.x_m, reference_mean.y_m - arm.y_m, theta_rad};

  // J = [1 0 -arm_y; 0 1 arm_x]: sums over the points follow from their mean and their spread.
  const float s =
      std::min(1.0F, config_.effective_points / count) / (config_.sigma_m * config_.sigma_m);
  const float tt = spread + count * (arm.x_m * arm.x_m + arm.y_m * arm.y_m);
  const float xt = -count * arm.y_m;
  const float yt = count * arm.x_m;
  report_.scan_information = {
      {s * count, 0.0F, s * xt, 0.0F, s * count, s * yt, s * xt, s * yt, s * tt}};
  report_.covariance = covariance_of(report_.scan_information, kUnknownVariance);
  const float length_m = std::max(0.1F, square_root(tt / count));
  report_.length_m = length_m;
  report_.conditioning = conditioning_of(report_.scan_information, length_m);
  report_.open_directions = open_directions(report_.conditioning, config_.max_condition);
  return is_finite(pose.x_m) && is_finite(pose.y_m) && is_finite(pose.theta_rad);
}

bool IcpMatcherCore::step() {
  if (done_) { return true; }
  const std::size_t pairs = find_partners();
  if (pairs < static_cast<std::size_t>(config_.min_pairs)) {
    return finish(MatchOutcome::out_of_map);
  }
  Pose2f pose = report_.pose;
  if (!improve(trim_limit(pairs), pose)) { return finish(MatchOutcome::unsolvable); }
  const std::array<float, 3> moved{pose.x_m - report_.pose.x_m, pose.y_m - report_.pose.y_m,
                                   wrap_angle(pose.theta_rad - report_.pose.theta_rad)};
  ++report_.iterations;
  report_.pose = pose;
  if (is_beyond(config_.max_total_m, config_.max_total_rad, request_.start, pose)) {
    return finish(MatchOutcome::step_limit);
  }
  const bool degenerate = !(report_.conditioning.condition <= config_.max_condition);
  if (is_below(config_.converged_m, config_.converged_rad, moved)) {
    return finish(degenerate ? MatchOutcome::degenerate : MatchOutcome::converged);
  }
  if (report_.iterations >= config_.max_iterations) {
    return finish(degenerate ? MatchOutcome::degenerate : MatchOutcome::iteration_limit);
  }
  return false;
}

MatchReport IcpMatcherCore::match(const PointsView& reference, const MatchRequest& request) {
  begin(reference, request);
  while (!step()) {}  // at most max_iterations
  return report_;
}

}  // namespace picolo::inline v0
