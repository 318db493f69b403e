// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Whether a row of accepted matches is to be believed.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::inline v0 {

/// When accepted matches are to be doubted. Poor ones and jumps do not help a pose to be trusted
/// again. A jump raises the doubt by two, one that fits poorly by four; a good match without jump
/// lowers it by one.
struct MatchTrust {
  float good_inlier_share = 0.5F;  ///< a match with fewer points near obstacles is poor
  /// ... and doubtful when it agrees less: it is no new surroundings that it sees.
  float poor_agreement = 0.9F;
  /// After the pose was lost a match with fewer is poor: a place that looks like another one
  /// differs from it somewhere.
  float found_again_agreement = 0.85F;
  /// A match that agrees less contradicts the map: it counts as rejected, and after two in a row
  /// the pose is unproven.
  float min_agreement = 0.5F;
  int found_again_matches = 5;  ///< good ones in a row, before the pose is believed again
  /// A correction that moves the pose further is a jump, told as an event, ...
  float max_correction_m = 0.05F;
  float max_correction_rad = 0.035F;  ///< ... or turns it further
  int max_doubt = 3;                  ///< beyond it the sensors disagree
  /// A correction this long, or turn, is no error of the odometry: somebody has moved the vehicle,
  /// or the match is wrong. The pose is unproven, until the whole map has been searched.
  float max_leap_m = 0.3F;
  float max_leap_rad = 0.2F;
  /// Corrections that keep pointing the same way add up to a pull; chance ones cancel. Beyond these
  /// the sensors disagree.
  float max_pull_m = 0.07F;
  float max_pull_rad = 0.02F;
  float pull_kept = 0.97F;  ///< share that remains from one match to the next
  /// Once sensors have contradicted each other or themselves, so many good matches in a row without
  /// a jump have to prove the pose.
  int proof_matches = 10;
  int pull_proof_matches = 50;  ///< the same after a pull, which nothing has explained
  /// Factor on the limits of turns of a jump and of a pull while the wheels tell the turn alone:
  /// they slip.
  float without_gyro = 2.5F;
  /// ... and no turn further than this is believed before a match confirms it: a wheel that counts
  /// wrongly makes a turn of a straight way, ...
  float max_wheel_turn_rad = 0.04F;
  /// ... or hides one, this much a metre: what one wheel may count wrongly over the track.
  float hidden_turn_per_m = 0.4F;
  /// Without a match for longer, what is seen afterwards has to prove the pose as after a loss.
  Duration max_unmatched = 1s;
  [[nodiscard]] constexpr bool valid() const {
    return good_inlier_share >= 0.0F && poor_agreement >= 0.0F && poor_agreement <= 1.0F &&
           good_inlier_share <= 1.0F && max_correction_m >= 0.0F && max_correction_rad >= 0.0F &&
           found_again_agreement >= 0.0F && found_again_agreement <= 1.0F &&
           min_agreement >= 0.0F && min_agreement <= 1.0F && max_leap_m > 0.0F &&
           max_leap_rad > 0.0F && found_again_matches > 0 && max_doubt >= 0 && proof_matches >= 0 &&
           pull_proof_matches >= proof_matches && without_gyro >= 1.0F &&
           max_wheel_turn_rad > 0.0F && hidden_turn_per_m >= 0.0F && max_unmatched > Duration{0} &&
           max_pull_m > 0.0F && max_pull_rad > 0.0F && pull_kept >= 0.0F && pull_kept < 1.0F;
  }
};

/// What a judge of matches is told of each.
struct JudgedMatch {
  bool accepted = false;
  HealthReason rejection = HealthReason::match_rejected;  ///< why it is not
  float inlier_share = 0.0F;
  float agreement = 0.0F;  ///< see LocaliserCore::agreement
  bool jumped = false;     ///< it moved the pose further than `max_correction_...`
  bool pulled = false;     ///< so did the last ones together, see `max_pull_...`
  bool leapt = false;      ///< it moved the pose further than `max_leap_...`
};

/// Counts what speaks for the pose and what against it. Cost: every call O(1). Context: cycle only.
class PoseTrust {
 public:
  explicit PoseTrust(const MatchTrust& config) : config_(config) {}

  void matched(const JudgedMatch& match);
  /// The pose was lost, set by somebody, or may be anywhere: it is to be proven by
  /// `found_again_matches` good ones in a row.
  void distrust();
  /// The pose was set: what was held against the one before no longer counts.
  void reset();

  /// Good ones since the last that was not; rejected ones and contradictions since the last that
  /// was neither.
  [[nodiscard]] int accepted_streak() const { return accepted_streak_; }
  [[nodiscard]] int rejected_streak() const { return rejected_streak_; }
  [[nodiscard]] HealthReason rejection() const { return rejection_; }
  [[nodiscard]] bool unproven() const { return unproven_; }
  /// Lidar and odometry tell different motions.
  [[nodiscard]] bool disagrees(bool searching) const {
    return pulled_ || doubt_ > config_.max_doubt || (doubt_ > 0 && searching);
  }
  /// Judged before each publication: whether sensors contradict each other, and the match's age.
  void update(bool contradicted, Duration unmatched);
  /// A contradiction has yet to be forgiven.
  [[nodiscard]] bool proving() const { return proof_left_ > 0; }
  /// Nothing seen should enter the map.
  [[nodiscard]] bool holds_map() const { return hold_left_ > 0; }

 private:
  MatchTrust config_;
  int accepted_streak_ = 0;
  int rejected_streak_ = 0;
  int doubt_ = 0;
  int proof_left_ = 0;  // matches until a contradiction is forgiven
  int hold_left_ = 0;   // matches until the map may change again
  bool was_contradicted_ = false;
  HealthReason rejection_ = HealthReason::match_rejected;
  bool pulled_ = false;
  bool unproven_ = false;
};

}  // namespace picolo::inline v0
