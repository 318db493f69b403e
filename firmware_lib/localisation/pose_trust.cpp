// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/pose_trust.hpp"

#include <algorithm>
#include <limits>

namespace picolo::inline v0 {
namespace {

constexpr int kContradictions = 2;  // in a row: the pose is not where it is said to be
constexpr int kDoubtful = 2;  // steps that a doubtful match raises what any other lowers by one

void count_up(int& streak) {
  if (streak < std::numeric_limits<int>::max()) { ++streak; }
}

}  // namespace

void PoseTrust::matched(const JudgedMatch& match) {
  const bool contradicts = match.accepted && match.agreement < config_.min_agreement;
  if (!match.accepted || (contradicts && !unproven_)) {
    count_up(rejected_streak_);
    accepted_streak_ = 0;
    rejection_ = match.accepted ? HealthReason::match_rejected : match.rejection;
  } else if (!contradicts) {
    rejected_streak_ = 0;
  }
  if (!match.accepted) { return; }
  if (contradicts && rejected_streak_ >= kContradictions) { distrust(); }
  const bool poor = contradicts || match.inlier_share < config_.good_inlier_share ||
                    (unproven_ && match.agreement < config_.found_again_agreement);
  if (poor || match.jumped) {
    accepted_streak_ = 0;
  } else {
    count_up(accepted_streak_);
  }
  if (accepted_streak_ >= config_.found_again_matches) { unproven_ = false; }
  const bool doubtful = poor && match.agreement < config_.poor_agreement;
  if (match.jumped || doubtful) {
    doubt_ += match.jumped && poor ? 2 * kDoubtful : kDoubtful;
  } else if (!poor) {  // a poor match in new surroundings says nothing
    doubt_ -= 1;
  }
  doubt_ = std::clamp(doubt_, 0, config_.max_doubt + 2 * kDoubtful);
  if (match.jumped) {
    proof_left_ = proof_left_ > 0 ? std::max(proof_left_, config_.proof_matches) : 0;
  } else if (!poor) {
    proof_left_ = std::max(0, proof_left_ - 1);
    hold_left_ = std::max(0, hold_left_ - 1);
  }
  // A lidar that told the same for seconds has drawn the pose along.
  if ((match.pulled && !unproven_ && !pulled_) || match.leapt) { distrust(); }
  pulled_ = match.pulled;
}

void PoseTrust::update(bool contradicted, Duration unmatched) {
  if (unmatched > config_.max_unmatched && !unproven_) { distrust(); }
  if (contradicted) {
    proof_left_ =
        std::max(proof_left_, pulled_ ? config_.pull_proof_matches : config_.proof_matches);
  }
  if (contradicted && !was_contradicted_) { hold_left_ = config_.found_again_matches; }
  was_contradicted_ = contradicted;
}

void PoseTrust::distrust() {
  unproven_ = true;
  accepted_streak_ = 0;
}

void PoseTrust::reset() {
  accepted_streak_ = 0;
  rejected_streak_ = 0;
  doubt_ = 0;
  proof_left_ = 0;
  hold_left_ = 0;
  pulled_ = false;
}

}  // namespace picolo::inline v0
