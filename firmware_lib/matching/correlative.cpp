// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/correlative.hpp"

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

constexpr int kFarCell = 1 << 20;
constexpr int kMaxAngles = 1 << 12;

/// First and last step i in [-half, half] with 0 <= cell + i * step < size.
struct StepRange {
  int first;
  int last;
};

StepRange steps_inside(int cell, int step, int half, int size) {
  StepRange range{-half, half};
  if (cell - half * step >= 0 && cell + half * step < size) { return range; }
  while (range.first <= half && cell + range.first * step < 0) { ++range.first; }
  while (range.last >= -half && cell + range.last * step >= size) { --range.last; }
  return range;
}

int step_cells_on(const CorrelativeConfig& config, const DistanceFieldView& field) {
  return round_to_i32(config.translation_step_m * field.cells_per_m, 1, kFarCell);
}

}  // namespace

float CorrelativeSearch::max_half_m(const DistanceFieldView& field) const {
  return static_cast<float>(kMaxSearchHalfSteps * step_factor_ * step_cells_on(config_, field)) /
         field.cells_per_m;
}

Status CorrelativeSearch::begin(const DistanceFieldView& field, const PointsView& points,
                                const SearchWindow& window, const PosePrior& prior) {
  angle_ = 1;
  last_angle_ = 0;
  found_ = 0;
  if (!config_.valid() || !(window.half_translation_m >= 0.0F) ||
      !(window.half_rotation_rad >= 0.0F)) {
    return Status::invalid_argument;
  }
  if (points.size() == 0) { return Status::degenerate; }
  step_cells_ = step_factor_ * step_cells_on(config_, field);
  const float step_m = static_cast<float>(step_cells_) / field.cells_per_m;
  half_steps_ = round_to_i32(window.half_translation_m / step_m, 0, kFarCell);
  if (half_steps_ > kMaxSearchHalfSteps) { return Status::full; }
  side_ = 2 * half_steps_ + 1;
  field_ = field;
  points_ = points;
  window_ = window;
  point_count_ = std::min(points.size(), static_cast<std::size_t>(config_.max_points));
  table_ = make_score_table(config_.score, field.reach_m);
  penalty_ = make_penalty(config_.score, prior, point_count_);
  last_angle_ = round_to_i32(window.half_rotation_rad / config_.rotation_step_rad, 0, kMaxAngles);
  angle_ = -last_angle_;
  begin_angle();
  return Status::ok;
}

void CorrelativeSearch::begin_angle() {
  const SinCos<float> yaw =
      sin_cos(window_.centre.theta_rad + static_cast<float>(angle_) * config_.rotation_step_rad);
  sine_ = yaw.sine;
  cosine_ = yaw.cosine;
  next_point_ = 0;
  plane_of(angle_).fill(0);
}

bool CorrelativeSearch::step(std::size_t max_lookups) {
  std::size_t lookups = 0;
  while (!done() && lookups < std::max(max_lookups, std::size_t{1})) {
    add_point(next_point_);
    ++next_point_;
    lookups += static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
    if (next_point_ == point_count_) { end_angle(); }
  }
  return done();
}

void CorrelativeSearch::add_point(std::size_t k) {
  const std::size_t index = spread_index(k, point_count_, points_.size());
  const float x_m = points_.x_m[index];
  const float y_m = points_.y_m[index];
  const float column_f = (window_.centre.x_m + (cosine_ * x_m - sine_ * y_m)) * field_.cells_per_m;
  const float row_f = (window_.centre.y_m + (sine_ * x_m + cosine_ * y_m)) * field_.cells_per_m;
  const int column = floor_to_i32(column_f, -kFarCell, kFarCell);
  const int row = floor_to_i32(row_f, -kFarCell, kFarCell);
  const StepRange columns = steps_inside(column, step_cells_, half_steps_, field_.width);
  const StepRange rows = steps_inside(row, step_cells_, half_steps_, field_.height);
  if (columns.first > columns.last) { return; }

  const std::uint8_t* const table = table_.data();
  const std::ptrdiff_t stride = step_cells_;
  const std::ptrdiff_t count = columns.last - columns.first + 1;
  for (int j = rows.first; j <= rows.last; ++j) {
    const std::uint8_t* const cells =
        field_.cells + static_cast<std::ptrdiff_t>(row + j * step_cells_) * field_.width +
        (column + columns.first * step_cells_);
    std::uint16_t* const scores =
        plane_of(angle_).data() + (j + half_steps_) * side_ + (columns.first + half_steps_);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      scores[i] = static_cast<std::uint16_t>(scores[i] + table[cells[i * stride]]);
    }
  }
}

// The plane of this angle is complete: charge the prior, then the plane before it has both its
// neighbours.
void CorrelativeSearch::end_angle() {
  Plane& plane = plane_of(angle_);
  const float step_m = static_cast<float>(step_cells_) / field_.cells_per_m;
  const std::int32_t turn = penalty_.theta(window_.centre.theta_rad +
                                           static_cast<float>(angle_) * config_.rotation_step_rad);
  std::array<std::int32_t, kSide> along_x{};
  for (int i = 0; i < side_; ++i) {
    along_x[static_cast<std::size_t>(i)] =
        penalty_.x(window_.centre.x_m + static_cast<float>(i - half_steps_) * step_m);
  }
  for (int j = 0; j < side_; ++j) {
    const std::int32_t line =
        turn + penalty_.y(window_.centre.y_m + static_cast<float>(j - half_steps_) * step_m);
    for (int i = 0; i < side_; ++i) {
      std::uint16_t& score = plane[static_cast<std::size_t>(j * side_ + i)];
      const std::int32_t left = score - line - along_x[static_cast<std::size_t>(i)];
      score = static_cast<std::uint16_t>(std::max<std::int32_t>(left, 0));
    }
  }
  if (angle_ > -last_angle_) {
    const Plane* const below = angle_ - 1 > -last_angle_ ? &plane_of(angle_ - 2) : nullptr;
    collect(angle_ - 1, below, plane_of(angle_ - 1), &plane);
  }
  if (angle_ == last_angle_) {
    collect(angle_, last_angle_ > 0 ? &plane_of(angle_ - 1) : nullptr, plane, nullptr);
  }
  ++angle_;
  if (!done()) { begin_angle(); }
}

// A local maximum is above every neighbour before it and not below any after it in the order of
// (theta, y, x), so that of two equal neighbours the first is taken.
void CorrelativeSearch::collect(int angle, const Plane* below, const Plane& here,
                                const Plane* above) {
  const auto limit = static_cast<std::size_t>(config_.max_candidates);
  const std::array<const Plane*, 3> planes{below, &here, above};
  const auto is_maximum = [&](int row, int column, std::uint16_t score) {
    for (int a = 0; a < 3; ++a) {
      const Plane* const plane = planes[static_cast<std::size_t>(a)];
      if (plane == nullptr) { continue; }
      for (int j = std::max(0, row - 1); j <= std::min(side_ - 1, row + 1); ++j) {
        for (int i = std::max(0, column - 1); i <= std::min(side_ - 1, column + 1); ++i) {
          const std::uint16_t other = (*plane)[static_cast<std::size_t>(j * side_ + i)];
          const bool earlier = a < 1 || (a == 1 && (j < row || (j == row && i < column)));
          if (other > score || (earlier && other == score)) { return false; }
        }
      }
    }
    return true;
  };
  for (int row = 0; row < side_; ++row) {
    for (int column = 0; column < side_; ++column) {
      const std::uint16_t score = here[static_cast<std::size_t>(row * side_ + column)];
      const bool enters = score > 0 && (found_ < limit || score > candidate_scores_[found_ - 1]);
      if (enters && is_maximum(row, column, score)) { insert(angle, row, column, score); }
    }
  }
}

void CorrelativeSearch::insert(int angle, int row, int column, std::uint16_t score) {
  const float step_m = static_cast<float>(step_cells_) / field_.cells_per_m;
  const PoseCandidate candidate{
      {window_.centre.x_m + static_cast<float>(column - half_steps_) * step_m,
       window_.centre.y_m + static_cast<float>(row - half_steps_) * step_m,
       wrap_angle(window_.centre.theta_rad +
                  static_cast<float>(angle) * config_.rotation_step_rad)},
      static_cast<float>(score) /
          (static_cast<float>(kFullScore) * static_cast<float>(point_count_))};
  if (found_ < static_cast<std::size_t>(config_.max_candidates)) { ++found_; }
  std::size_t at = found_ - 1;
  for (; at > 0 && candidate_scores_[at - 1] < score; --at) {
    candidate_scores_[at] = candidate_scores_[at - 1];
    candidates_[at] = candidates_[at - 1];
  }
  candidate_scores_[at] = score;
  candidates_[at] = candidate;
}

float CorrelativeSearch::upper_bound() const {
  if (!done()) { return 1.0F; }
  return found_ > 0 ? candidates_[0].score : 0.0F;
}

Status CorrelativeSearch::search(const DistanceFieldView& field, const PointsView& points,
                                 const SearchWindow& window, const PosePrior& prior) {
  const Status status = begin(field, points, window, prior);
  while (!step(1U << 20)) {}
  return status;
}

}  // namespace picolo::inline v0
