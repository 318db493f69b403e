// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Levenberg-Marquardt beside Gauss-Newton on the same residuals: every accepted step lowers the
/// cost, so it holds where Gauss-Newton hops between minima (Madsen, Nielsen, Tingleff 2004,
/// "Methods for non-linear least squares problems", algorithm 3.16).
#pragma once

#include "picolo/map/likelihood_field.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "picolo/matching/match_report.hpp"

namespace picolo::inline v0 {

struct LevenbergMarquardtConfig {
  GaussNewtonConfig residual{};   ///< residuals, kernel, guards and stop as in Gauss-Newton; an
                                  ///< iteration is a trial, accepted or not
  float initial_damping = 1e-3F;  ///< of the largest diagonal element of H
  [[nodiscard]] constexpr bool valid() const { return residual.valid() && initial_damping > 0.0F; }
};
static_assert(LevenbergMarquardtConfig{}.valid());

/// (H + mu I) dT = b with the angle scaled to metres by the scan's mean radius; mu by Nielsen's
/// rule from the gain ratio, true decrease of the robust cost over the decrease the model
/// predicted. Same calls and same report as GaussNewtonMatcher; `accepted()` counts the trials that
/// moved. Cost: O(points) a trial, about 150 instructions a point when accepted, 60 when not.
/// Context: cycle only.
template <LikelihoodField Field>
class LevenbergMarquardtMatcher {
 public:
  explicit LevenbergMarquardtMatcher(const LevenbergMarquardtConfig& config = {})
      : config_(config) {}

  void begin(const Field& field, const MatchRequest& request);
  /// One trial; true when the report is final. Calling it again then changes nothing.
  bool step();
  [[nodiscard]] const MatchReport& report() const { return report_; }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] int accepted() const { return accepted_; }
  /// Robust cost of scan and prior at the report's pose, in units of half a squared sigma.
  [[nodiscard]] float cost() const { return cost_; }

  /// begin, step until done, report.
  [[nodiscard]] MatchReport match(const Field& field, const MatchRequest& request);

 private:
  bool linearise();
  bool finish(MatchOutcome outcome);
  [[nodiscard]] float cost_at(const Pose2f& pose) const;
  [[nodiscard]] StepSolution damped_step() const;

  LevenbergMarquardtConfig config_;
  Field field_{};
  MatchRequest request_{};
  MatchReport report_{};
  NormalEquations3 system_{};  // of scan and prior at the report's pose
  float scale_ = 1.0F;  // from unit-free residuals to an information
  float cost_ = 0.0F;
  float damping_ = 0.0F;
  float growth_ = 2.0F;
  int accepted_ = 0;
  bool linearised_ = false;
  bool degenerate_ = false;
  bool done_ = true;
};

extern template class LevenbergMarquardtMatcher<DistanceFieldView>;

}  // namespace picolo::inline v0
