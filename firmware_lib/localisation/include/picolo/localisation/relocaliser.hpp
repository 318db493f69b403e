// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where in the whole map a sweep fits, without any idea of the pose: branch and bound in slices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/map/max_pyramid.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/pose_search.hpp"

namespace picolo::inline v0 {

struct RelocaliseConfig {
  bool enabled = true;
  int after_sweeps = 2;         ///< in a row that fit nowhere near the pose
  std::size_t min_points = 60;  ///< of a sweep: fewer fit at many places
  /// Of the best place, another one is refined too that scores so much of it ...
  float rival_score = 0.9F;
  float apart_m = 0.5F;     ///< ... and is further away, ...
  float apart_rad = 0.35F;  ///< ... or turned further.
  /// A place is taken when the points agree with it by this (see LocaliserCore::agreement), and the
  /// other is contradicted by twice as many and by this share of the points.
  float min_agreement = 0.85F;
  float rival_margin = 0.03F;
  /// To search a map that the vehicle has made on a drive longer than this, from end to end, takes
  /// longer than it may go on blindly. There sweeps are searched for only when they agree less than
  /// this with what is near, and a pose that nobody has set is proven by a way over which all of
  /// them agree by `min_agreement`.
  float longest_search_m = 15.0F;
  float lost_agreement = 0.5F;
  float proof_way_m = 3.0F;
  std::uint32_t nodes_per_step = 32;  ///< as long as `SearchConfig::lookups_per_step`
  PoseSearchConfig poses{.rotation_step_rad = 0.034906585F,  // 2 deg
                         .min_score = 0.45F,
                         .max_nodes = 8'000'000};
  [[nodiscard]] constexpr bool valid() const {
    return after_sweeps >= 0 && rival_score > 0.0F && rival_score <= 1.0F && apart_m > 0.0F &&
           longest_search_m > 0.0F && lost_agreement >= 0.0F && proof_way_m > 0.0F &&
           apart_rad > 0.0F && min_agreement >= 0.0F && min_agreement <= 1.0F &&
           rival_margin >= 0.0F && nodes_per_step > 0 && poses.valid();
  }
  /// The points cannot tell this place from the best.
  [[nodiscard]] bool as_good(float agreement, float best) const;
};
static_assert(RelocaliseConfig{}.valid());

/// `begin`, `step` until it returns true, then `places`: none, the best one, or the best one and
/// its strongest rival elsewhere. Only places near cells of the coarse map that were seen free are
/// looked at. The pyramid lies in memory that the fine map lends: no scan may enter the map, nor
/// its window move, until the end. Context: cycle only.
class Relocaliser {
 public:
  /// Everything referred to outlives this. Precondition: the coarse map has cells of 4 times the
  /// size.
  Relocaliser(const RelocaliseConfig& config, RollingMapCore& fine, const RollingMapCore& coarse);

  /// `points` in base; they must stay valid until the last step. False: too few.
  bool begin(const PointsView& points);
  /// One slice; `search` is used until the end, by nobody else. Cost: `nodes_per_step` bounds and
  /// at most one row of squares; or one row of the pyramid.
  bool step(PoseSearch& search);

  /// Poses in the fine map's window, best first, with their scores; the caller may improve them.
  [[nodiscard]] std::span<PoseCandidate> places() { return {places_.data(), found_}; }
  [[nodiscard]] std::span<const PoseCandidate> places() const { return {places_.data(), found_}; }
  /// Two places, not one twice.
  [[nodiscard]] bool apart(const Pose2f& a, const Pose2f& b) const;
  /// Looked at every pose: what is not among the places fits worse.
  [[nodiscard]] bool exact() const { return exact_; }
  /// Bounds evaluated.
  [[nodiscard]] std::uint32_t nodes() const { return nodes_; }

 private:
  enum class Phase : std::uint8_t { over, surveying, building, best, rival };

  void survey_row();
  [[nodiscard]] bool begin_search(PoseSearch& search);
  void end_search(PoseSearch& search);

  const RelocaliseConfig& config_;
  RollingMapCore& fine_;
  const RollingMapCore& coarse_;
  MaxPyramidCore pyramid_;
  PointsView points_{};
  std::array<PoseCandidate, 2> places_{};
  std::size_t found_ = 0;
  std::uint32_t nodes_ = 0;
  int row_ = 0;           // of the coarse map
  int first_column_ = 0;  // cells of the coarse map that were seen free, their bounds
  int last_column_ = -1;
  int first_row_ = 0;
  int last_row_ = -1;
  Phase phase_ = Phase::over;
  bool exact_ = false;
};

}  // namespace picolo::inline v0
