// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Correlative matching on a regular grid of poses (Olson 2009, "Real-time correlative scan
/// matching"): every pose of a window is scored, so that no start value is needed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/map/likelihood_field.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/matching/score_table.hpp"

namespace picolo::inline v0 {

inline constexpr int kMaxSearchHalfSteps = 12;  ///< of a window's half side
inline constexpr std::size_t kMaxCandidates = 8;

struct CorrelativeConfig {
  float translation_step_m = 0.1F;         ///< rounded to whole cells, at least one
  float rotation_step_rad = 0.034906585F;  ///< 2 deg
  int max_points = 96;                     ///< of the scan, evenly chosen; at most kMaxSearchPoints
  int max_candidates = 4;                  ///< at most kMaxCandidates
  SearchScore score{};
  [[nodiscard]] constexpr bool valid() const {
    return translation_step_m > 0.0F && rotation_step_rad > 0.0F && max_points > 0 &&
           max_points <= static_cast<int>(kMaxSearchPoints) && max_candidates > 0 &&
           max_candidates <= static_cast<int>(kMaxCandidates) && score.valid();
  }
};
static_assert(CorrelativeConfig{}.valid());

/// All poses within the half sizes of the centre, window axes.
struct SearchWindow {
  Pose2f centre{};  ///< window_T_base
  float half_translation_m = 0.5F;
  float half_rotation_rad = 0.5235988F;
};

struct PoseCandidate {
  Pose2f pose{};       ///< window_T_base
  float score = 0.0F;  ///< mean over the points less the prior's penalty; in [0, 1]
};

/// Resumable: `begin`, then `step` until it returns true. The candidates are the best local maxima
/// among the 26 neighbours, best first, equal ones in the order of (theta, y, x); before the end
/// they are the best so far. All scores are integers: the answer does not depend on the order of
/// summation. Memory: 4.5 KiB. Context: cycle only; a field that changes during the search mixes
/// old and new values, nothing worse.
class CorrelativeSearch {
 public:
  explicit CorrelativeSearch(const CorrelativeConfig& config = {}) : config_(config) {}

  /// `points` in base; they must stay valid until the last step. `prior`: only the diagonal of its
  /// information is used; zero for none.
  /// `invalid_argument`: configuration or window; `full`: more than kMaxSearchHalfSteps steps of
  /// translation; `degenerate`: no points. After a failure there is nothing to step.
  Status begin(const DistanceFieldView& field, const PointsView& points, const SearchWindow& window,
               const PosePrior& prior = {});

  /// Steps of translation this many times as long as configured, for the searches to come.
  void lengthen_steps(int factor) { step_factor_ = factor; }
  /// The largest half side of a window that `begin` takes on this field.
  [[nodiscard]] float max_half_m(const DistanceFieldView& field) const;

  /// Looks up about `max_lookups` more cells (at least one point's); true when the search is over.
  /// Cost: about 8 instructions a lookup.
  bool step(std::size_t max_lookups);
  [[nodiscard]] bool done() const { return angle_ > last_angle_; }
  [[nodiscard]] std::span<const PoseCandidate> candidates() const {
    return {candidates_.data(), found_};
  }
  /// No pose of the window scores higher than this: 1 before the end, then the best score.
  [[nodiscard]] float upper_bound() const;

  /// begin and step until done, for host users and for callers that have the time.
  Status search(const DistanceFieldView& field, const PointsView& points,
                const SearchWindow& window, const PosePrior& prior = {});

 private:
  static constexpr int kSide = 2 * kMaxSearchHalfSteps + 1;
  using Plane = std::array<std::uint16_t, static_cast<std::size_t>(kSide) * kSide>;

  void begin_angle();
  void add_point(std::size_t k);
  void end_angle();
  void collect(int angle, const Plane* below, const Plane& here, const Plane* above);
  void insert(int angle, int row, int column, std::uint16_t score);
  [[nodiscard]] Plane& plane_of(int angle) {
    return planes_[static_cast<std::size_t>(angle + 3 * last_angle_) % planes_.size()];
  }

  CorrelativeConfig config_;
  DistanceFieldView field_{};
  PointsView points_{};
  SearchWindow window_{};
  ScoreTable table_{};
  PriorPenalty penalty_{};
  std::array<Plane, 3> planes_{};  // scores of three neighbouring angles
  std::array<PoseCandidate, kMaxCandidates> candidates_{};
  std::array<std::uint16_t, kMaxCandidates> candidate_scores_{};
  std::size_t found_ = 0;
  std::size_t point_count_ = 0;
  std::size_t next_point_ = 0;
  int step_factor_ = 1;
  int step_cells_ = 1;
  int half_steps_ = 0;
  int side_ = 1;
  int angle_ = 1;
  int last_angle_ = 0;
  float sine_ = 0.0F;
  float cosine_ = 1.0F;
};

}  // namespace picolo::inline v0
