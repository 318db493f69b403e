// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/ndt.hpp"

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/ndt_sums.hpp"
#include "pose_steps.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kLeastCurvature = 1e-3F;  // of the largest eigenvalue, after the safeguard

/// H + lambda I with the angle scaled to metres, lambda just large enough for a safe inverse.
void make_positive(float length_m, Matrix3f& hessian) {
  const Conditioning conditioning = conditioning_of(hessian, length_m);
  const float low = conditioning.eigenvalues[0];
  const float high = std::max(conditioning.eigenvalues[2], -low);
  const float wanted = kLeastCurvature * high;
  if (low >= wanted) { return; }
  const float lambda = wanted - low;
  hessian(0, 0) += lambda;
  hessian(1, 1) += lambda;
  hessian(2, 2) += lambda * (length_m * length_m);
}

float mean_radius(const PointsView& points) {
  float sum = 0.0F;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const float squared = points.x_m[k] * points.x_m[k] + points.y_m[k] * points.y_m[k];
    sum += is_finite(squared) ? squared : 0.0F;
  }
  return std::max(0.1F, square_root(sum / static_cast<float>(points.size())));
}

}  // namespace

void NdtMatcher::begin(const NdtView& view, const MatchRequest& request) {
  view_ = view;
  request_ = request;
  report_ = {};
  report_.pose = request.start;
  report_.covariance = Matrix3f::diagonal(kUnknownVariance, kUnknownVariance, kUnknownVariance);
  cost_ = 0.0F;
  blur_ = config_.first_blur;
  started_ = false;
  degenerate_ = false;
  done_ = false;
  if (request.points.size() < static_cast<std::size_t>(config_.min_points)) {
    finish(MatchOutcome::too_few_points);
    return;
  }
  const auto all = static_cast<float>(request.points.size());
  scale_ = std::min(1.0F, config_.effective_points / all) / static_cast<float>(kNdtGrids);
  length_m_ = mean_radius(request.points);
}

bool NdtMatcher::finish(MatchOutcome outcome) {
  report_.outcome = outcome;
  done_ = true;
  if (!keeps_pose(outcome)) { report_.pose = request_.start; }
  return true;
}

NdtMatcher::Linearised NdtMatcher::linearise(const Pose2f& pose) const {
  const SinCos<float> yaw = sin_cos(pose.theta_rad);
  const NdtSums sums = walk_ndt(
      view_, {pose.x_m, pose.y_m, yaw.sine, yaw.cosine, 1.0F / (blur_ * blur_)}, request_.points);
  Linearised at;
  at.points = sums.points;
  at.inliers = sums.inliers;
  at.residual_m = sums.residual_m;
  for (std::size_t i = 0; i < 9; ++i) {
    at.scan_information.elements[i] = scale_ * sums.information.elements[i];
    at.system.h.elements[i] = scale_ * sums.hessian.elements[i];
  }
  for (std::size_t i = 0; i < 3; ++i) { at.system.b[i] = -scale_ * sums.gradient[i]; }
  const std::array<float, 3> error = prior_error(request_.prior, pose);
  at.cost = 0.5F * quadratic_form(request_.prior.information, error) - scale_ * sums.score;
  if (is_prior(request_.prior)) { add_prior(request_.prior, pose, at.system); }
  return at;
}

/// Moves the report to the pose; false when the match is over.
bool NdtMatcher::accept(const Pose2f& pose, const Linearised& at) {
  const auto all = static_cast<float>(request_.points.size());
  report_.points = round_to_i32(at.points, 0, 1 << 24);
  if (report_.points < config_.min_points || at.points < config_.min_share_in_map * all) {
    finish(MatchOutcome::out_of_map);
    return false;
  }
  report_.pose = pose;
  report_.mean_residual_m = at.residual_m / at.points;
  report_.inlier_share = at.inliers / all;
  report_.scan_information = at.scan_information;
  cost_ = at.cost;
  system_ = at.system;
  return plan_step();
}

/// The next trial from where the report stands; false when the match is over.
bool NdtMatcher::plan_step() {
  const Conditioning& conditioning = report_.conditioning =
      conditioning_of(report_.scan_information, length_m_);
  report_.length_m = length_m_;
  report_.open_directions = open_directions(conditioning, config_.max_condition);
  degenerate_ = !(conditioning.condition <= config_.max_condition);
  const bool with_prior = is_prior(request_.prior);
  Matrix3f information = report_.scan_information;
  if (with_prior) { information = sum(information, request_.prior.information); }
  report_.covariance = covariance_of(information, kUnknownVariance);

  StepSolution solution;
  if (degenerate_ && !with_prior) {
    // Along what the scan constrains the positive part of the Hessian serves.
    solution = solve_constrained(system_, conditioning, length_m_, config_.max_condition);
  } else {
    NormalEquations3 safe = system_;
    make_positive(length_m_, safe.h);
    solution = solve(safe);
  }
  if (!solution.solved) {
    finish(MatchOutcome::unsolvable);
    return false;
  }
  step_ = solution.step;
  shorten(config_.max_step_m, config_.max_step_rad, step_);
  return true;
}

/// The stage has converged: the next sharper one, or the end.
bool NdtMatcher::settle() {
  if (blur_ > 1.0F) {
    blur_ = std::max(1.0F, 0.5F * blur_);
    started_ = false;
    return false;
  }
  return finish(degenerate_ ? MatchOutcome::degenerate : MatchOutcome::converged);
}

bool NdtMatcher::step() {
  if (done_) { return true; }
  if (!started_) {
    started_ = true;
    if (!accept(report_.pose, linearise(report_.pose))) { return true; }
  }
  // Early stages need not converge to the millimetre.
  if (is_below(blur_ * config_.converged_m, blur_ * config_.converged_rad, step_)) {
    return settle();
  }
  const Pose2f trial = moved_by(report_.pose, step_);
  if (is_beyond(config_.max_total_m, config_.max_total_rad, request_.start, trial)) {
    return finish(MatchOutcome::step_limit);
  }
  ++report_.iterations;
  const Linearised at = linearise(trial);
  if (at.cost < cost_) {
    if (!accept(trial, at)) { return true; }
  } else {
    for (float& component : step_) { component *= 0.5F; }
  }
  if (report_.iterations >= config_.max_iterations) {
    return finish(degenerate_ ? MatchOutcome::degenerate : MatchOutcome::iteration_limit);
  }
  return false;
}

MatchReport NdtMatcher::match(const NdtView& view, const MatchRequest& request) {
  begin(view, request);
  while (!step()) {}  // at most max_iterations
  return report_;
}

}  // namespace picolo::inline v0
