// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/levenberg_marquardt.hpp"

#include <algorithm>

#include "field_system.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/field_cost.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kNoGain = 1e-6F;  // of the cost: below it a float cannot tell two costs apart
constexpr float kMaxDamping = 1e15F;

float dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

}  // namespace

template <LikelihoodField Field>
void LevenbergMarquardtMatcher<Field>::begin(const Field& field, const MatchRequest& request) {
  field_ = field;
  request_ = request;
  report_ = {};
  report_.pose = request.start;
  report_.covariance = Matrix3f::diagonal(kUnknownVariance, kUnknownVariance, kUnknownVariance);
  damping_ = 0.0F;
  growth_ = 2.0F;
  cost_ = 0.0F;
  accepted_ = 0;
  linearised_ = false;
  degenerate_ = false;
  done_ = false;
  if (request.points.size() < static_cast<std::size_t>(config_.residual.min_points)) {
    finish(MatchOutcome::too_few_points);
  }
}

template <LikelihoodField Field>
bool LevenbergMarquardtMatcher<Field>::finish(MatchOutcome outcome) {
  report_.outcome = outcome;
  done_ = true;
  if (!keeps_pose(outcome)) { report_.pose = request_.start; }
  return true;
}

template <LikelihoodField Field>
float LevenbergMarquardtMatcher<Field>::cost_at(const Pose2f& pose) const {
  const FieldWalk walk = walk_at(config_.residual, field_.reach_m, pose);
  const std::array<float, 3> error = prior_error(request_.prior, pose);
  return scale_ * cost_of_field(field_, walk, request_.points) +
         0.5F * quadratic_form(request_.prior.information, error);
}

/// False when the match is over.
template <LikelihoodField Field>
bool LevenbergMarquardtMatcher<Field>::linearise() {
  const GaussNewtonConfig& config = config_.residual;
  const FieldSums sums =
      walk_field(field_, walk_at(config, field_.reach_m, report_.pose), request_.points);
  report_.points = round_to_i32(sums.inside, 0, 1 << 24);
  const auto all = static_cast<float>(request_.points.size());
  if (report_.points < config.min_points || sums.inside < config.min_share_in_map * all) {
    finish(MatchOutcome::out_of_map);
    return false;
  }
  report_.mean_residual_m = field_.reach_m * sums.residual / sums.inside;
  report_.residual_variance_m2 =
      field_.reach_m * field_.reach_m * sums.robust_squares / sums.inside;
  report_.inlier_share = sums.inliers / all;
  report_.length_m = std::max(0.1F, square_root(sums.squared_radius / sums.inside));
  scale_ = information_scale(sums, config, field_.reach_m);
  system_ = scaled_system(sums, scale_);
  report_.scan_information = system_.h;
  const Conditioning& conditioning = report_.conditioning =
      conditioning_of(system_.h, report_.length_m);
  degenerate_ = !(conditioning.condition <= config.max_condition);
  report_.open_directions = open_directions(conditioning, config.max_condition);
  if (is_prior(request_.prior)) {
    if (degenerate_) {
      system_ = observable_part(system_, conditioning, report_.length_m, config.max_condition);
    }
    add_prior(request_.prior, report_.pose, system_);
  }
  report_.covariance = covariance_of(system_.h, kUnknownVariance);
  cost_ = cost_at(report_.pose);
  if (!(damping_ > 0.0F)) {
    const float turn = system_.h(2, 2) / (report_.length_m * report_.length_m);
    damping_ = config_.initial_damping * std::max(std::max(system_.h(0, 0), system_.h(1, 1)), turn);
  }
  linearised_ = true;
  return true;
}

// Directions that the scan leaves open take no step unless the prior speaks for them.
template <LikelihoodField Field>
StepSolution LevenbergMarquardtMatcher<Field>::damped_step() const {
  if (degenerate_ && !is_prior(request_.prior)) {
    Conditioning damped = report_.conditioning;
    const float least = damped.eigenvalues[2] / config_.residual.max_condition;
    for (float& eigenvalue : damped.eigenvalues) {
      eigenvalue = eigenvalue >= least && eigenvalue > 0.0F ? eigenvalue + damping_ : 0.0F;
    }
    return solve_constrained(system_, damped, report_.length_m, config_.residual.max_condition);
  }
  NormalEquations3 damped = system_;
  damped.h(0, 0) += damping_;
  damped.h(1, 1) += damping_;
  damped.h(2, 2) += damping_ * (report_.length_m * report_.length_m);
  return solve(damped);
}

template <LikelihoodField Field>
bool LevenbergMarquardtMatcher<Field>::step() {
  if (done_) { return true; }
  if (!linearised_ && !linearise()) { return true; }
  const MatchOutcome settled = degenerate_ ? MatchOutcome::degenerate : MatchOutcome::converged;
  StepSolution solution = damped_step();
  if (!solution.solved) { return finish(MatchOutcome::unsolvable); }
  shorten(config_.residual.max_step_m, config_.residual.max_step_rad, solution.step);
  const float predicted =
      dot(solution.step, system_.b) - 0.5F * quadratic_form(system_.h, solution.step);
  if (is_below(config_.residual.converged_m, config_.residual.converged_rad, solution.step) ||
      !(predicted > kNoGain * cost_)) {
    return finish(settled);
  }
  const Pose2f trial = moved_by(report_.pose, solution.step);
  if (is_beyond(config_.residual.max_total_m, config_.residual.max_total_rad, request_.start,
                trial)) {
    return finish(MatchOutcome::step_limit);
  }
  ++report_.iterations;
  const float gain = (cost_ - cost_at(trial)) / predicted;
  if (gain > 0.0F) {
    report_.pose = trial;
    ++accepted_;
    linearised_ = false;
    const float t = 2.0F * gain - 1.0F;
    damping_ *= std::max(1.0F / 3.0F, 1.0F - t * t * t);  // Nielsen 1999
    growth_ = 2.0F;
  } else {
    damping_ *= growth_;
    growth_ *= 2.0F;
    if (!(damping_ < kMaxDamping)) { return finish(settled); }
  }
  if (report_.iterations >= config_.residual.max_iterations) {
    return finish(degenerate_ ? MatchOutcome::degenerate : MatchOutcome::iteration_limit);
  }
  return false;
}

template <LikelihoodField Field>
MatchReport LevenbergMarquardtMatcher<Field>::match(const Field& field,
                                                    const MatchRequest& request) {
  begin(field, request);
  while (!step()) {}  // at most max_iterations
  return report_;
}

template class LevenbergMarquardtMatcher<DistanceFieldView>;

}  // namespace picolo::inline v0
