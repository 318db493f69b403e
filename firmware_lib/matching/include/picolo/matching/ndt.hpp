// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Matching against normal distributions by Newton's method (Biber and Strasser 2003).
#pragma once

#include "picolo/map/ndt_map.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/solve/normal_equations.hpp"

namespace picolo::inline v0 {

struct NdtConfig {
  int max_iterations = 40;  ///< trials, taken or shortened, of all stages together
  float first_blur = 4.0F;  ///< factor on every sigma in the first stage; halved by stage down to 1
  int min_points = 30;      ///< that meet a cell
  float min_share_in_map = 0.3F;   ///< of the points
  float converged_m = 1e-3F;       ///< stop when |dt| and |dtheta| are both below
  float converged_rad = 1.75e-4F;  ///< 0.01 deg
  float max_step_m = 0.2F;         ///< a longer step is shortened to this, its direction kept
  float max_step_rad = 0.17F;
  float max_total_m = 1.0F;  ///< from the start; beyond: step_limit
  float max_total_rad = 0.6F;
  float max_condition = 1000.0F;
  float effective_points = 60.0F;  ///< information counts at most this many
  [[nodiscard]] constexpr bool valid() const {
    return max_iterations > 0 && first_blur >= 1.0F && min_points >= 3 && converged_m > 0.0F &&
           converged_rad > 0.0F && max_step_m > 0.0F && max_step_rad > 0.0F && max_total_m > 0.0F &&
           max_total_rad > 0.0F && max_condition > 1.0F && effective_points > 0.0F;
  }
};
static_assert(NdtConfig{}.valid());

/// Newton on -score plus half of the prior's squared Mahalanobis distance. Where the Hessian is not
/// positive definite, a multiple of the identity (angle scaled to metres) makes it so; a trial that
/// does not raise the score is halved. Walls are thin, so the score is flat a few sigma away: the
/// first stages see every cell wider than it is. Same calls and report as GaussNewtonMatcher:
/// scan_information comes from the stiff part of the cells (see NdtCell), as the grids' mean,
/// mean_residual_m the distance from the cells' means along their thin direction, inlier_share the
/// points within 3 sigma. Cost: O(points) a trial, about 500 instructions a point. Context: cycle
/// only.
class NdtMatcher {
 public:
  explicit NdtMatcher(const NdtConfig& config = {}) : config_(config) {}

  void begin(const NdtView& view, const MatchRequest& request);
  /// One trial; true when the report is final. Calling it again then changes nothing.
  bool step();
  [[nodiscard]] const MatchReport& report() const { return report_; }
  [[nodiscard]] bool done() const { return done_; }
  /// What is minimised in the present stage, at the report's pose.
  [[nodiscard]] float cost() const { return cost_; }

  [[nodiscard]] float blur() const { return blur_; }  ///< of the present stage

  [[nodiscard]] MatchReport match(const NdtView& view, const MatchRequest& request);

 private:
  struct Linearised {
    NormalEquations3 system{};  // Hessian and minus gradient of scan and prior
    Matrix3f scan_information{};
    float cost = 0.0F;
    float points = 0.0F;
    float inliers = 0.0F;
    float residual_m = 0.0F;
  };
  [[nodiscard]] Linearised linearise(const Pose2f& pose) const;
  bool accept(const Pose2f& pose, const Linearised& at);
  bool plan_step();
  bool settle();
  bool finish(MatchOutcome outcome);

  NdtConfig config_;
  NdtView view_{};
  MatchRequest request_{};
  MatchReport report_{};
  NormalEquations3 system_{};
  std::array<float, 3> step_{};  // the trial, shortened so far
  float cost_ = 0.0F;
  float blur_ = 1.0F;
  float length_m_ = 1.0F;
  float scale_ = 1.0F;
  bool started_ = false;
  bool degenerate_ = false;
  bool done_ = true;
};

}  // namespace picolo::inline v0
