// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/pose_search.hpp"

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

bool fits(const DistanceFieldView& field, const MaxPyramidView& pyramid) {
  if (pyramid.levels < 1 || pyramid.levels > kMaxPyramidLevels) { return false; }
  for (int level = 0; level < pyramid.levels; ++level) {
    const auto l = static_cast<std::size_t>(level);
    if (pyramid.nearest[l] == nullptr ||
        pyramid.width[l] * MaxPyramidView::size_of(level) != field.width ||
        pyramid.height[l] * MaxPyramidView::size_of(level) != field.height) {
      return false;
    }
  }
  return true;
}

}  // namespace

Status PoseSearch::begin(const DistanceFieldView& field, const MaxPyramidView& pyramid,
                         const PointsView& points, const SearchWindow& window,
                         const PosePrior& prior, const PoseSearchArea& area) {
  phase_ = Phase::done;
  exact_ = false;
  bounded_ = false;
  search_.begin(config_.order, 0);
  if (!config_.valid() || !fits(field, pyramid) || !(window.half_translation_m >= 0.0F) ||
      !(window.half_rotation_rad >= 0.0F)) {
    return Status::invalid_argument;
  }
  if (points.size() == 0) { return Status::degenerate; }
  point_count_ = std::min(points.size(), static_cast<std::size_t>(config_.max_points));
  tree_.begin(field, pyramid, points, point_count_, window, prior, config_, area);
  top_level_ = pyramid.levels - 1;
  const int squares = (2 * tree_.half_cells()) / MaxPyramidView::size_of(top_level_) + 1;
  if (2 * tree_.half_angles() + 1 > static_cast<int>(kMaxSearchAngles) ||
      squares > static_cast<int>(kMaxRowSquares)) {
    return Status::full;
  }
  search_.begin(config_.order, score_units(config_.min_score));
  angle_bounds_.fill(0);
  angle_ = -tree_.half_angles();
  row_ = -tree_.half_cells();
  column_ = row_;
  kept_ = 0;
  phase_ = Phase::bounding;
  return Status::ok;
}

void PoseSearch::begin_elsewhere(const PoseExclusion& excluded, float min_score) {
  if (!exact_) { return; }
  exact_ = false;
  tree_.exclude(excluded);
  search_.begin(config_.order, score_units(min_score));
  for (std::uint16_t& bound : angle_bounds_) {
    bound = static_cast<std::uint16_t>(bound & ~kSearched);
  }
  phase_ = Phase::choosing;
}

std::int32_t PoseSearch::score_units(float score) const {
  const float full_score = static_cast<float>(kFullScore) * static_cast<float>(point_count_);
  return round_to_i32(score * full_score, 0, 1 << 20);
}

PoseNode PoseSearch::bounded_square() {
  PoseNode square{0, static_cast<std::int16_t>(angle_), static_cast<std::int16_t>(top_level_),
                  static_cast<std::int16_t>(column_), static_cast<std::int16_t>(row_)};
  square.bound = tree_.bound_of(square);
  return square;
}

/// True at the end of a row of squares.
bool PoseSearch::next_square() {
  const int size = MaxPyramidView::size_of(top_level_);
  column_ += size;
  if (column_ <= tree_.half_cells()) { return false; }
  column_ = -tree_.half_cells();
  row_ += size;
  return true;
}

void PoseSearch::bound_next_square() {
  std::uint16_t& bound = angle_bounds_[static_cast<std::size_t>(angle_ + tree_.half_angles())];
  bound = std::max(bound, static_cast<std::uint16_t>(bounded_square().bound));
  if (!next_square() || row_ <= tree_.half_cells()) { return; }
  row_ = -tree_.half_cells();
  ++angle_;
  if (angle_ > tree_.half_angles()) {
    bounded_ = true;
    phase_ = Phase::choosing;
  }
}

// The next angle whose bound is above the best pose, among those that were not searched.
void PoseSearch::choose_angle() {
  std::size_t chosen = angle_bounds_.size();
  std::int32_t highest = search_.best();
  for (std::size_t i = 0; i < angle_bounds_.size(); ++i) {
    if ((angle_bounds_[i] & kSearched) != 0 || angle_bounds_[i] <= highest) { continue; }
    chosen = i;
    if (config_.order == ChildOrder::index) { break; }
    highest = angle_bounds_[i];
  }
  if (chosen == angle_bounds_.size()) {
    exact_ = true;
    phase_ = Phase::done;
    return;
  }
  angle_ = static_cast<int>(chosen) - tree_.half_angles();
  row_ = -tree_.half_cells();
  phase_ = Phase::rows;
}

void PoseSearch::push_next_square() {
  const PoseNode square = bounded_square();
  if (square.bound > search_.best()) {
    search_.room()[kept_] = square;  // the stack is empty here
    ++kept_;
  }
  if (!next_square()) { return; }
  search_.push_written(kept_);
  kept_ = 0;
  phase_ = Phase::descending;
}

bool PoseSearch::step(std::uint32_t max_nodes) {
  const auto work = [this] { return tree_.nodes() + tree_.skipped(); };
  const std::uint32_t start = work();
  while (phase_ != Phase::done && work() - start < std::max<std::uint32_t>(max_nodes, 1)) {
    if (config_.max_nodes > 0 && tree_.nodes() >= config_.max_nodes) {
      phase_ = Phase::done;
      break;
    }
    switch (phase_) {
      case Phase::done: break;
      case Phase::bounding: bound_next_square(); break;
      case Phase::choosing: choose_angle(); break;
      case Phase::rows: push_next_square(); break;
      case Phase::descending:
        if (search_.step(tree_)) { break; }
        phase_ = Phase::rows;
        if (row_ > tree_.half_cells()) {
          angle_bounds_[static_cast<std::size_t>(angle_ + tree_.half_angles())] |= kSearched;
          phase_ = Phase::choosing;
        }
        break;
    }
  }
  return done();
}

PoseSearchReport PoseSearch::report() const {
  PoseSearchReport report;
  const float per_unit = 1.0F / (static_cast<float>(kFullScore) *
                                 static_cast<float>(std::max<std::size_t>(point_count_, 1)));
  report.nodes = tree_.nodes();
  report.found = search_.found();
  report.exact = exact_;
  if (report.found) {
    report.best = {tree_.pose_of(search_.best_node()),
                   static_cast<float>(search_.best()) * per_unit};
  }
  if (bounded_) {
    std::int32_t bound = search_.bound_left();
    for (const std::uint16_t angle_bound : angle_bounds_) {
      if ((angle_bound & kSearched) != 0) { continue; }
      bound = std::max(bound, static_cast<std::int32_t>(angle_bound));
    }
    report.upper_bound = static_cast<float>(exact_ ? search_.best() : bound) * per_unit;
  }
  return report;
}

Status PoseSearch::search(const DistanceFieldView& field, const MaxPyramidView& pyramid,
                          const PointsView& points, const SearchWindow& window,
                          const PosePrior& prior) {
  const Status status = begin(field, pyramid, points, window, prior);
  while (!step(1U << 16)) {}
  return status;
}

}  // namespace picolo::inline v0
