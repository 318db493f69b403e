// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Which start values the match gets beside the prediction, and which of its ends is kept.

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::inline v0 {

/// Keeps the better of the reports: the cheaper one, or after a wide search, which knows no prior,
/// the one that fits clearly more.
void LocaliserCore::consider(const MatchReport& report) {
  const bool wide = config_.search.enabled && searched_wide_;
  const bool better =
      !has_report_ || !usable(report_.outcome) ||
      (wide ? report.inlier_share >=
                  report_.inlier_share + (doubted_ ? 0.0F : config_.search.wide_gain)
            : report.cost < report_.cost);
  if (has_report_ && (!usable(report.outcome) || !better)) { return; }
  report_ = report;
  report_prior_ = request_.prior.information;
  has_report_ = true;
}

bool LocaliserCore::next_candidate() {
  const std::span<const PoseCandidate> candidates = searches_.near().candidates();
  if (candidate_ >= candidates.size()) { return false; }
  refine(candidates[candidate_].pose);
  ++candidate_;
  return true;
}

bool LocaliserCore::fits() const {
  if (!usable(report_.outcome)) { return false; }
  const SearchConfig& search = config_.search;
  const float enough = doubted_ ? search.doubted_inlier_share : search.below_inlier_share;
  if (report_.inlier_share >= enough) { return true; }
  return report_.inlier_share >= config_.min_inlier_share && agreement_of(report_) >= enough;
}

// A few points fit at many places.
bool LocaliserCore::worth_a_search() const {
  return report_.outcome != MatchOutcome::too_few_points;
}

bool LocaliserCore::begin_search() {
  if (searched_ || !worth_a_search()) { return false; }
  const SearchConfig& search = config_.search;
  const Pose2d motion = between(accepted_odom_T_base_, sweep_.odom_T_base);
  const double turn = magnitude(motion.theta_rad);
  const bool far = !with_odometry_ ||
                   hypotenuse(motion.x_m, motion.y_m) > static_cast<double>(search.after_m) ||
                   turn > static_cast<double>(search.after_rad);
  if (!far && fits()) { return false; }
  searched_ = true;
  CorrelativeSearch& near = searches_.near();
  near.lengthen_steps(1);
  const SearchWindow window{
      .centre = request_.prior.pose,
      .half_translation_m =
          std::clamp(3.0F * translation_sigma_m_, search.min_half_m, search.max_half_m),
      .half_rotation_rad =
          std::clamp(3.0F * rotation_sigma_rad_, search.min_half_rad, search.max_half_rad)};
  if (near.begin(fine_.field(), sweep_.points, window, request_.prior) != Status::ok) {
    return false;
  }
  ++counters_.searched;
  stage_ = Stage::search;
  return true;
}

bool LocaliserCore::begin_wide_search() {
  const bool anywhere = doubted_ && config_.relocalise.enabled;  // covers it
  if (searched_wide_ || anywhere || !worth_a_search()) { return false; }
  const SearchConfig& search = config_.search;
  if (fits()) { return false; }
  searched_wide_ = true;
  CorrelativeSearch& near = searches_.near();
  near.lengthen_steps(doubted_ ? 2 : 1);
  request_.prior.information = {};
  const SearchWindow window{
      .centre = to_window(fine_.window(), accepted_map_T_base_),
      .half_translation_m = std::min(doubted_ ? 2.0F * search.wide_half_m : search.wide_half_m,
                                     near.max_half_m(fine_.field())),
      .half_rotation_rad = search.wide_half_rad};
  if (near.begin(fine_.field(), sweep_.points, window) != Status::ok) { return false; }
  ++counters_.searched_wide;
  stage_ = Stage::search;
  return true;
}

}  // namespace picolo::inline v0
