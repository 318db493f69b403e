// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The best pose of a window at the resolution of a cell, by branch and bound over a max pyramid
/// (Hess, Kohler, Rapp, Andor 2016, "Real-time loop closure in 2D LIDAR SLAM"): exact, however
/// large the window, and cut into slices so that relocalisation never breaks a deadline.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/map/likelihood_field.hpp"
#include "picolo/map/max_pyramid.hpp"
#include "picolo/matching/branch_and_bound.hpp"
#include "picolo/matching/correlative.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/matching/score_table.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kMaxSearchAngles = 361;  ///< the full circle at one degree

/// Where the base may stand: within about a cell of a free one of a coarser grid. No cells:
/// anywhere in the window.
struct PoseSearchArea {
  const std::int8_t* log_odds = nullptr;  ///< row-major; below 0: free
  int width = 0;
  int height = 0;
  int shift = 0;     ///< a cell has 2^shift cells of the field along each side
  int offset_x = 0;  ///< corner of the field's window in the grid, in cells of the field
  int offset_y = 0;
};

/// Poses that do not count: within both limits of the pose. within_m = 0: none.
struct PoseExclusion {
  Pose2f pose{};  ///< window_T_base
  float within_m = 0.0F;
  float within_rad = 0.0F;
};

struct PoseSearchConfig {
  float rotation_step_rad = 0.017453293F;  ///< 1 deg: a cell of 8 cm at 4.6 m
  int max_points = 96;                     ///< of the scan, evenly chosen; at most kMaxSearchPoints
  float min_score = 0.0F;                  ///< only poses above count; a high one prunes early
  ChildOrder order = ChildOrder::best_first;
  std::uint32_t max_nodes = 0;  ///< bounds evaluated before it gives up; 0: no limit
  SearchScore score{};
  [[nodiscard]] constexpr bool valid() const {
    return rotation_step_rad > 0.0F && max_points > 0 &&
           max_points <= static_cast<int>(kMaxSearchPoints) && min_score >= 0.0F && score.valid();
  }
};
static_assert(PoseSearchConfig{}.valid());

struct PoseSearchReport {
  PoseCandidate best{};      ///< precondition: found
  float upper_bound = 1.0F;  ///< no pose of the window scores higher
  std::uint32_t nodes = 0;   ///< bounds evaluated so far; each looks at every chosen point once
  bool found = false;        ///< a pose above min_score is known
  bool exact = false;        ///< the search ended by itself: `best` is the best of the window
};

/// A square of poses of one angle: `size` x `size` cells of translation whose lower left corner is
/// (x, y) cells from the centre. level -1: one cell, its bound is the score.
struct PoseNode {
  std::int32_t bound = 0;
  std::int16_t angle = 0;
  std::int16_t level = -1;
  std::int16_t x = 0;
  std::int16_t y = 0;
};

/// The tree of poses: bounds from the pyramid, scores from the field. Private to `PoseSearch` and
/// its tests.
class PoseTree {
 public:
  using Node = PoseNode;
  static constexpr std::size_t kMaxChildren =
      static_cast<std::size_t>(kPyramidBaseCells) * kPyramidBaseCells;

  void begin(const DistanceFieldView& field, const MaxPyramidView& pyramid,
             const PointsView& points, std::size_t point_count, const SearchWindow& window,
             const PosePrior& prior, const PoseSearchConfig& config,
             const PoseSearchArea& area = {});
  void exclude(const PoseExclusion& excluded) { excluded_ = excluded; }

  [[nodiscard]] bool is_leaf(const Node& node) const { return node.level < 0; }
  std::size_t expand(const Node& node, std::span<Node> children);
  /// Turns the points to the angle (kept until the next angle) and bounds the square.
  [[nodiscard]] std::int32_t bound_of(const Node& node);
  [[nodiscard]] Pose2f pose_of(const Node& node) const;

  [[nodiscard]] int half_cells() const { return half_cells_; }
  [[nodiscard]] int half_angles() const { return half_angles_; }
  [[nodiscard]] std::uint32_t nodes() const { return nodes_; }
  /// Squares that were ruled out without a look at the points, as work: a few to a node.
  [[nodiscard]] std::uint32_t skipped() const { return skipped_ / kSkipsPerNode; }

 private:
  static constexpr std::uint32_t kSkipsPerNode = 16;

  [[nodiscard]] bool may_stand_in(const Node& node, int size) const;
  [[nodiscard]] bool excludes(const Node& node, int size) const;
  void turn_to(int angle);
  [[nodiscard]] std::int32_t least_penalty(const Node& node, int size) const;

  DistanceFieldView field_{};
  MaxPyramidView pyramid_{};
  PointsView points_{};
  SearchWindow window_{};
  ScoreTable table_{};
  PriorPenalty penalty_{};
  PoseSearchArea area_{};
  PoseExclusion excluded_{};
  int centre_column_ = 0;  // cell of the field in which the centre lies
  int centre_row_ = 0;
  float rotation_step_rad_ = 0.0F;
  std::size_t point_count_ = 0;
  int half_cells_ = 0;
  int half_angles_ = 0;
  int turned_to_ = 0;
  bool turned_ = false;
  std::array<std::int16_t, kMaxSearchPoints> column_{};  // of the points at the centre, turned
  std::array<std::int16_t, kMaxSearchPoints> row_{};
  std::int32_t turn_penalty_ = 0;
  std::uint32_t nodes_ = 0;
  std::uint32_t skipped_ = 0;
};

/// Resumable: `begin`, then `step` until it returns true; `report` at any time. First every angle
/// gets the bound of its best square, then the angles are searched in the order of their bounds
/// (or by index), a row of squares at a time. Memory: 4 KiB. Context: cycle only; field and pyramid
/// must rest during the search for an exact answer.
class PoseSearch {
 public:
  explicit PoseSearch(const PoseSearchConfig& config = {}) : config_(config) {}

  /// `pyramid` of the same field. `points` in base must stay valid until the last step.
  /// `invalid_argument`: configuration, window, or a pyramid that does not fit the field; `full`:
  /// more than kMaxSearchAngles angles or kMaxRowSquares squares a row; `degenerate`: no points.
  Status begin(const DistanceFieldView& field, const MaxPyramidView& pyramid,
               const PointsView& points, const SearchWindow& window, const PosePrior& prior = {},
               const PoseSearchArea& area = {});
  /// After a search that ended exactly: the same question again, for poses that are not excluded
  /// and score above `min_score`. The bounds of the angles are kept.
  void begin_elsewhere(const PoseExclusion& excluded, float min_score);

  /// Evaluates about `max_nodes` more bounds, at most the children of one node more; true
  /// when over.
  /// Cost: about 25 instructions a point and node.
  bool step(std::uint32_t max_nodes);
  [[nodiscard]] bool done() const { return phase_ == Phase::done; }
  [[nodiscard]] PoseSearchReport report() const;

  Status search(const DistanceFieldView& field, const MaxPyramidView& pyramid,
                const PointsView& points, const SearchWindow& window, const PosePrior& prior = {});

  static constexpr std::size_t kMaxRowSquares = 128;

 private:
  enum class Phase : std::uint8_t { done, bounding, choosing, rows, descending };

  static constexpr std::uint16_t kSearched = 0x8000;  // flag of an angle; bounds are smaller

  [[nodiscard]] PoseNode bounded_square();
  [[nodiscard]] std::int32_t score_units(float score) const;
  [[nodiscard]] bool next_square();
  void bound_next_square();
  void choose_angle();
  void push_next_square();

  PoseSearchConfig config_;
  PoseTree tree_{};
  BranchAndBound<PoseTree, kMaxRowSquares + kMaxPyramidLevels * PoseTree::kMaxChildren> search_{};
  std::array<std::uint16_t, kMaxSearchAngles> angle_bounds_{};
  std::size_t point_count_ = 0;
  Phase phase_ = Phase::done;
  int top_level_ = 0;
  int angle_ = 0;
  int row_ = 0;
  int column_ = 0;
  std::size_t kept_ = 0;  // squares of the row so far
  bool bounded_ = false;  // every angle has its bound
  bool exact_ = false;
};

}  // namespace picolo::inline v0
