// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/gauss_newton.hpp"

#include <algorithm>

#include "field_system.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {

template <LikelihoodField Field>
void GaussNewtonMatcher<Field>::begin(const Field& field, const MatchRequest& request) {
  field_ = field;
  request_ = request;
  report_ = {};
  report_.pose = request.start;
  report_.covariance = Matrix3f::diagonal(kUnknownVariance, kUnknownVariance, kUnknownVariance);
  done_ = false;
  damping_ = 1.0F;
  last_step_ = {};
  if (request.points.size() < static_cast<std::size_t>(config_.min_points)) {
    finish(MatchOutcome::too_few_points);
  }
}

template <LikelihoodField Field>
bool GaussNewtonMatcher<Field>::finish(MatchOutcome outcome) {
  report_.outcome = outcome;
  done_ = true;
  if (outcome != MatchOutcome::converged && outcome != MatchOutcome::iteration_limit &&
      outcome != MatchOutcome::degenerate) {
    report_.pose = request_.start;
  }
  return true;
}

template <LikelihoodField Field>
bool GaussNewtonMatcher<Field>::enough_points(int inside) {
  const auto all = static_cast<float>(request_.points.size());
  return inside >= config_.min_points &&
         static_cast<float>(inside) >= config_.min_share_in_map * all;
}

// The field bends at every cell centre: full steps may jump to and fro across a bend for ever. A
// step that turns back against the last one is halved, and so are all that follow.
template <LikelihoodField Field>
void GaussNewtonMatcher<Field>::damp(std::array<float, 3>& step) {
  const float along = (step[0] * last_step_[0] + step[1] * last_step_[1]) +
                      report_.length_m * report_.length_m * step[2] * last_step_[2];
  if (along < 0.0F) { damping_ *= 0.5F; }
  for (float& component : step) { component *= damping_; }
  last_step_ = step;
}

template <LikelihoodField Field>
bool GaussNewtonMatcher<Field>::step() {
  if (done_) { return true; }
  const FieldSums sums =
      walk_field(field_, walk_at(config_, field_.reach_m, report_.pose), request_.points);
  report_.points = round_to_i32(sums.inside, 0, 1 << 24);
  if (!enough_points(report_.points)) { return finish(MatchOutcome::out_of_map); }
  report_.mean_residual_m = field_.reach_m * sums.residual / sums.inside;
  report_.residual_variance_m2 =
      field_.reach_m * field_.reach_m * sums.robust_squares / sums.inside;
  report_.inlier_share = sums.inliers / static_cast<float>(request_.points.size());
  report_.length_m = std::max(0.1F, square_root(sums.squared_radius / sums.inside));

  report_.cost = cost_of(sums, config_, field_.reach_m, request_, report_.pose);
  NormalEquations3 system = scaled_system(sums, information_scale(sums, config_, field_.reach_m));
  report_.scan_information = system.h;
  const Conditioning& conditioning = report_.conditioning =
      conditioning_of(system.h, report_.length_m);
  const bool degenerate = !(conditioning.condition <= config_.max_condition);
  const bool with_prior = is_prior(request_.prior);
  report_.open_directions = open_directions(conditioning, config_.max_condition);
  if (with_prior) {
    if (degenerate) {
      system = observable_part(system, conditioning, report_.length_m, config_.max_condition);
    }
    add_prior(request_.prior, report_.pose, system);
  }
  report_.covariance = covariance_of(system.h, kUnknownVariance);

  StepSolution solution =
      degenerate && !with_prior
          ? solve_constrained(system, conditioning, report_.length_m, config_.max_condition)
          : solve(system);
  if (!solution.solved) { return finish(MatchOutcome::unsolvable); }
  shorten(config_.max_step_m, config_.max_step_rad, solution.step);
  damp(solution.step);
  report_.pose = {report_.pose.x_m + solution.step[0], report_.pose.y_m + solution.step[1],
                  wrap_angle(report_.pose.theta_rad + solution.step[2])};
  ++report_.iterations;

  const float moved_m =
      hypotenuse(report_.pose.x_m - request_.start.x_m, report_.pose.y_m - request_.start.y_m);
  const float turned_rad = wrap_angle(report_.pose.theta_rad - request_.start.theta_rad);
  if (moved_m > config_.max_total_m || turned_rad > config_.max_total_rad ||
      turned_rad < -config_.max_total_rad) {
    return finish(MatchOutcome::step_limit);
  }
  const float turn_rad = magnitude(solution.step[2]);
  if (hypotenuse(solution.step[0], solution.step[1]) < config_.converged_m &&
      turn_rad < config_.converged_rad) {
    return finish(degenerate ? MatchOutcome::degenerate : MatchOutcome::converged);
  }
  if (report_.iterations >= config_.max_iterations) {
    return finish(degenerate ? MatchOutcome::degenerate : MatchOutcome::iteration_limit);
  }
  return false;
}

template <LikelihoodField Field>
MatchReport GaussNewtonMatcher<Field>::match(const Field& field, const MatchRequest& request) {
  begin(field, request);
  while (!step()) {}  // at most max_iterations
  return report_;
}

template class GaussNewtonMatcher<DistanceFieldView>;

}  // namespace picolo::inline v0
