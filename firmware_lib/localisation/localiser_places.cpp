// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A doubted sweep that fits nowhere near the pose is searched for in the whole map.

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::inline v0 {

bool LocaliserCore::begin_relocalisation() {
  const RelocaliseConfig& config = config_.relocalise;
  const bool at_once = unverified_ && !proves_by_way();
  const bool due = at_once || (unfit_in_a_row_ >= config.after_sweeps && !fits());
  if (relocalisation_ != Relocalisation::none || !config.enabled || !doubted_ || !due ||
      !worth_a_search() || !relocaliser_.begin(sweep_.points)) {
    return false;
  }
  ++counters_.searched_anywhere;
  searches_.use_anywhere(config.poses);
  request_.prior.information = {};
  ambiguous_ = false;
  place_ = 0;
  relocalisation_ = Relocalisation::searching;
  stage_ = Stage::relocalise;
  return true;
}

/// Each place is refined with the whole sweep, then the one that is chosen once more: so no second
/// report has to be kept.
bool LocaliserCore::next_place() {
  const std::span<const PoseCandidate> places = relocaliser_.places();
  if (relocalisation_ == Relocalisation::refining && place_ < places.size()) {
    refine(places[place_].pose);
    return true;
  }
  if (relocalisation_ != Relocalisation::refining) { return false; }
  if (!choose_place()) {
    relocalisation_ = Relocalisation::over;
    return false;
  }
  ++counters_.found_anywhere;
  relocalisation_ = Relocalisation::settling;
  refine(places[place_].pose);
  return true;
}

void LocaliserCore::judge_place(const MatchReport& report) {
  if (relocalisation_ == Relocalisation::settling) {
    report_ = report;
    report_prior_ = request_.prior.information;
    settled_ = true;
    relocalisation_ = Relocalisation::over;
    return;
  }
  PoseCandidate& place = relocaliser_.places()[place_];
  place = {report.pose, usable(report.outcome) ? agreement_of(report) : 0.0F};
  ++place_;
}

/// The place with which the sweep agrees, in place_; false when there is none, or two, or when the
/// pose stays where it is.
bool LocaliserCore::choose_place() {
  const RelocaliseConfig& config = config_.relocalise;
  const std::span<const PoseCandidate> places = relocaliser_.places();
  if (!relocaliser_.exact()) { return false; }
  if (stays()) {
    unverified_ = false;
    given_ = true;
    return false;
  }
  if (places.empty()) { return false; }
  place_ = places.size() > 1 && places[1].score > places[0].score ? 1 : 0;
  const float best = places[place_].score;
  if (best < config.min_agreement) { return false; }
  const bool elsewhere = places.size() > 1 && relocaliser_.apart(places[0].pose, places[1].pose);
  ambiguous_ = elsewhere && config.as_good(places[1 - place_].score, best);
  if (ambiguous_) { return false; }
  unverified_ = false;
  given_ = true;  // for the doubts to come: the odometry has carried the pose on from here
  return true;
}

/// The sweep agrees with the map from the pose that is there, and no place elsewhere does as well;
/// a pose that was given needs no more than to be as good. New surroundings agree nowhere else.
bool LocaliserCore::stays() const {
  const RelocaliseConfig& config = config_.relocalise;
  if (!usable(report_.outcome) || report_.inlier_share < config_.min_inlier_share) { return false; }
  const float here = agreement_of(report_);
  if (here < config.min_agreement) { return false; }
  for (const PoseCandidate& place : relocaliser_.places()) {
    const bool rivals =
        place.score >= config.min_agreement && relocaliser_.apart(report_.pose, place.pose);
    const bool better =
        given_ ? !config.as_good(here, place.score) : config.as_good(place.score, here);
    if (rivals && better) { return false; }
  }
  return true;
}

bool LocaliserCore::searches_slowly() const {
  const float longer_m =
      std::max(mapped_to_.x_m - mapped_from_.x_m, mapped_to_.y_m - mapped_from_.y_m);
  return !localises_only_ && longer_m > config_.relocalise.longest_search_m;
}

bool LocaliserCore::proves_by_way() const {
  return unverified_ && !given_ && searches_slowly();
}

/// Of an accepted match; what agrees too little has ended the proof, see note_fit.
void LocaliserCore::prove_by_way() {
  const RelocaliseConfig& config = config_.relocalise;
  if (agreement_ < config.min_agreement) { return; }
  const Pose2f since = to_f32(between(accepted_map_T_base_, map_T_base_));
  proof_way_m_ += hypotenuse(since.x_m, since.y_m);
  if (proof_way_m_ < config.proof_way_m) { return; }
  unverified_ = false;
  given_ = true;
}

/// Of the match that is over.
void LocaliserCore::note_fit() {
  const RelocaliseConfig& config = config_.relocalise;
  if (agreement_ < config.min_agreement) { proof_way_m_ = 0.0F; }
  if (!doubted_ ||
      agreement_ >= (searches_slowly() ? config.lost_agreement : config.min_agreement)) {
    unfit_in_a_row_ = 0;
    return;
  }
  const bool searched = relocalisation_ != Relocalisation::none;
  unfit_in_a_row_ = searched ? 0 : unfit_in_a_row_ + 1;
  if (searched) { unverified_ = true; }
}

}  // namespace picolo::inline v0
