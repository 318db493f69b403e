// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Gauss-Newton matching of a scan against a likelihood field (Kohlbrecher, von Stryk, Meyer,
/// Klingauf 2011, "A flexible and scalable SLAM system with full 3D motion estimation", eq. 7-13).
#pragma once

#include <array>

#include "picolo/map/likelihood_field.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/solve/normal_equations.hpp"

namespace picolo::inline v0 {

struct GaussNewtonConfig {
  int max_iterations = 30;
  int min_points = 30;            ///< inside of the window
  float min_share_in_map = 0.3F;  ///< of the points
  /// Stop when |dt| and |dtheta| are both below. Kohlbrecher's 1 mm and 0.01 deg leave so much of
  /// the way that two runs with hardly different input drift apart by 0.3 deg over 300 scans; a
  /// twentieth costs three iterations more.
  float converged_m = 5e-5F;
  float converged_rad = 1e-5F;
  float max_step_m = 0.2F;  ///< a longer step is shortened to this, its direction kept
  float max_step_rad = 0.17F;
  float max_total_m = 1.0F;  ///< from the start; beyond: step_limit
  float max_total_rad = 0.6F;
  /// Beyond it a direction is open. With points that constrain across their surface only, the ratio
  /// of the eigenvalues is the mean square of the normals' share along the weakest direction;
  /// normals that err by 0.05 rad feign 1 / 400, those of a circle with stairs 1 / 100, with noise
  /// now and then 1 / 50.
  float max_condition = 60.0F;
  float sigma_m = 0.05F;  ///< of one residual
  /// Neighbouring beams are not independent: information counts at most this many.
  float effective_points = 100.0F;
  float kernel_m = 0.15F;  ///< Cauchy kernel's width; 0 switches the kernel off
  float inlier_m = 0.10F;
  [[nodiscard]] constexpr bool valid() const {
    return max_iterations > 0 && min_points >= 3 && converged_m > 0.0F && converged_rad > 0.0F &&
           max_step_m > 0.0F && max_step_rad > 0.0F && max_total_m > 0.0F && max_total_rad > 0.0F &&
           max_condition > 1.0F && sigma_m > 0.0F && effective_points > 0.0F && kernel_m >= 0.0F &&
           inlier_m > 0.0F;
  }
};

/// Resumable: `begin`, then `step` (one iteration each) until it returns true, then `report`;
/// `match` is that loop. Residual r_i = 1 - M(S_i(T)), J_i = grad M * dS_i/dT, (sum J'J) dT = sum
/// J' r, T <- T + dT; both sums weighted by the kernel and scaled to an information, to which the
/// prior's is added. Cost: O(points) an iteration, about 100 instructions a point. Context: cycle
/// only.
template <LikelihoodField Field>
class GaussNewtonMatcher {
 public:
  explicit GaussNewtonMatcher(const GaussNewtonConfig& config = {}) : config_(config) {}

  void begin(const Field& field, const MatchRequest& request);
  /// One iteration; true when the report is final. Calling it again then changes nothing.
  bool step();
  [[nodiscard]] const MatchReport& report() const { return report_; }
  [[nodiscard]] bool done() const { return done_; }

  /// begin, step until done, report.
  [[nodiscard]] MatchReport match(const Field& field, const MatchRequest& request);

  [[nodiscard]] const GaussNewtonConfig& config() const { return config_; }

 private:
  [[nodiscard]] bool enough_points(int inside);
  bool finish(MatchOutcome outcome);
  void damp(std::array<float, 3>& step);

  GaussNewtonConfig config_;
  Field field_{};
  MatchRequest request_{};
  MatchReport report_{};
  std::array<float, 3> last_step_{};
  float damping_ = 1.0F;
  bool done_ = true;
};

extern template class GaussNewtonMatcher<DistanceFieldView>;

}  // namespace picolo::inline v0
