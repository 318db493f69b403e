// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/pose_search.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kFarCell = 16000;  // outside of every window, and so are its neighbours

/// Least penalty over the whole offsets [low, high]: it grows on both sides of the prior, so one of
/// the two offsets around the prior, moved into the range, has it.
template <typename PenaltyAt>
std::int32_t least_over(int low, int high, float wanted, PenaltyAt penalty_at) {
  const int below = floor_to_i32(wanted, -kFarCell, kFarCell);
  return std::min(penalty_at(std::clamp(below, low, high)),
                  penalty_at(std::clamp(below + 1, low, high)));
}

}  // namespace

void PoseTree::begin(const DistanceFieldView& field, const MaxPyramidView& pyramid,
                     const PointsView& points, std::size_t point_count, const SearchWindow& window,
                     const PosePrior& prior, const PoseSearchConfig& config,
                     const PoseSearchArea& area) {
  field_ = field;
  pyramid_ = pyramid;
  points_ = points;
  point_count_ = point_count;
  window_ = window;
  table_ = make_score_table(config.score, field.reach_m);
  penalty_ = make_penalty(config.score, prior, point_count);
  rotation_step_rad_ = config.rotation_step_rad;
  half_cells_ = round_to_i32(window.half_translation_m * field.cells_per_m, 0, kFarCell);
  half_angles_ = round_to_i32(window.half_rotation_rad / config.rotation_step_rad, 0, kFarCell);
  turned_ = false;
  nodes_ = 0;
  skipped_ = 0;
  area_ = area;
  excluded_ = {};
  centre_column_ = floor_to_i32(window.centre.x_m * field.cells_per_m, -kFarCell, kFarCell);
  centre_row_ = floor_to_i32(window.centre.y_m * field.cells_per_m, -kFarCell, kFarCell);
}

// A cell of the area more on each side: a base close to a wall shares its coarse cell with the
// wall.
bool PoseTree::may_stand_in(const Node& node, int size) const {
  if (area_.log_odds == nullptr) { return true; }
  const int column = centre_column_ + node.x + area_.offset_x;
  const int row = centre_row_ + node.y + area_.offset_y;
  const int first_i = std::max((column >> area_.shift) - 1, 0);
  const int first_j = std::max((row >> area_.shift) - 1, 0);
  const int last_i = std::min(((column + size - 1) >> area_.shift) + 1, area_.width - 1);
  const int last_j = std::min(((row + size - 1) >> area_.shift) + 1, area_.height - 1);
  for (int j = first_j; j <= last_j; ++j) {
    const std::int8_t* const line = area_.log_odds + static_cast<std::ptrdiff_t>(j) * area_.width;
    for (int i = first_i; i <= last_i; ++i) {
      if (line[i] < 0) { return true; }
    }
  }
  return false;
}

bool PoseTree::excludes(const Node& node, int size) const {
  if (excluded_.within_m <= 0.0F) { return false; }
  const Pose2f low = pose_of(node);
  const float turn_rad = wrap_angle(low.theta_rad - excluded_.pose.theta_rad);
  if (turn_rad > excluded_.within_rad || turn_rad < -excluded_.within_rad) { return false; }
  const float side_m = static_cast<float>(size - 1) / field_.cells_per_m;
  const float x_m = low.x_m - excluded_.pose.x_m;
  const float y_m = low.y_m - excluded_.pose.y_m;
  const float far_x_m = std::max(x_m + side_m, -x_m);
  const float far_y_m = std::max(y_m + side_m, -y_m);
  return far_x_m * far_x_m + far_y_m * far_y_m <= excluded_.within_m * excluded_.within_m;
}

Pose2f PoseTree::pose_of(const Node& node) const {
  const float cell_m = 1.0F / field_.cells_per_m;
  return {
      window_.centre.x_m + static_cast<float>(node.x) * cell_m,
      window_.centre.y_m + static_cast<float>(node.y) * cell_m,
      wrap_angle(window_.centre.theta_rad + static_cast<float>(node.angle) * rotation_step_rad_)};
}

void PoseTree::turn_to(int angle) {
  if (turned_ && turned_to_ == angle) { return; }
  turned_ = true;
  turned_to_ = angle;
  const float theta_rad = window_.centre.theta_rad + static_cast<float>(angle) * rotation_step_rad_;
  turn_penalty_ = penalty_.theta(theta_rad);
  const SinCos<float> yaw = sin_cos(theta_rad);
  for (std::size_t k = 0; k < point_count_; ++k) {
    const std::size_t index = spread_index(k, point_count_, points_.size());
    const float x_m = points_.x_m[index];
    const float y_m = points_.y_m[index];
    const float column = (window_.centre.x_m + (yaw.cosine * x_m - yaw.sine * y_m));
    const float row = (window_.centre.y_m + (yaw.sine * x_m + yaw.cosine * y_m));
    column_[k] =
        static_cast<std::int16_t>(floor_to_i32(column * field_.cells_per_m, -kFarCell, kFarCell));
    row_[k] =
        static_cast<std::int16_t>(floor_to_i32(row * field_.cells_per_m, -kFarCell, kFarCell));
  }
}

std::int32_t PoseTree::least_penalty(const Node& node, int size) const {
  const float cell_m = 1.0F / field_.cells_per_m;
  const Pose2f& centre = window_.centre;
  const Pose2f& wanted = penalty_.prior.pose;
  const std::int32_t along_x =
      least_over(node.x, node.x + size - 1, (wanted.x_m - centre.x_m) * field_.cells_per_m,
                 [&](int x) { return penalty_.x(centre.x_m + static_cast<float>(x) * cell_m); });
  const std::int32_t along_y =
      least_over(node.y, node.y + size - 1, (wanted.y_m - centre.y_m) * field_.cells_per_m,
                 [&](int y) { return penalty_.y(centre.y_m + static_cast<float>(y) * cell_m); });
  return turn_penalty_ + along_x + along_y;
}

std::int32_t PoseTree::bound_of(const Node& node) {
  const int size = node.level < 0 ? 1 : MaxPyramidView::size_of(node.level);
  if (!may_stand_in(node, size) || excludes(node, size)) {
    ++skipped_;
    return 0;
  }
  turn_to(node.angle);
  ++nodes_;
  const std::uint8_t* cells = field_.cells;
  int width = field_.width;
  int height = field_.height;
  int shift = 0;
  if (node.level >= 0) {
    const auto level = static_cast<std::size_t>(node.level);
    cells = pyramid_.nearest[level];
    width = pyramid_.width[level];
    height = pyramid_.height[level];
    shift = 2 + node.level;
  }
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < point_count_; ++k) {
    // A square that begins left of or below the window, but reaches into it, lies within twice the
    // first square: its byte bounds it too.
    const int column = column_[k] + node.x;
    const int row = row_[k] + node.y;
    if (column <= -size || row <= -size) { continue; }
    const int i = std::max(column, 0) >> shift;
    const int j = std::max(row, 0) >> shift;
    if (i >= width || j >= height) { continue; }
    sum += table_[cells[static_cast<std::ptrdiff_t>(j) * width + i]];
  }
  return std::max<std::int32_t>(sum - least_penalty(node, size), 0);
}

std::size_t PoseTree::expand(const Node& node, std::span<Node> children) {
  const bool to_leaves = node.level == 0;
  const int size = to_leaves ? 1 : MaxPyramidView::size_of(node.level - 1);
  const int across = to_leaves ? kPyramidBaseCells : 2;
  std::size_t count = 0;
  for (int j = 0; j < across; ++j) {
    for (int i = 0; i < across; ++i) {
      const int x = node.x + i * size;
      const int y = node.y + j * size;
      if (x > half_cells_ || y > half_cells_) { continue; }
      Node& child = children[count];
      child = {0, node.angle, static_cast<std::int16_t>(node.level - 1),
               static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
      child.bound = bound_of(child);
      ++count;
    }
  }
  return count;
}

}  // namespace picolo::inline v0
