// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/map_matcher.hpp"

#include <algorithm>
#include <array>

#include "local_shape.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/vector3_inline.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kMaxNeighbours = 8;

}  // namespace

bool has_pose(SolveOutcome outcome) {
  return outcome == SolveOutcome::converged || outcome == SolveOutcome::iteration_limit ||
         outcome == SolveOutcome::degenerate;
}

void MapMatcher::begin(const VoxelMapCore& edge_map, const VoxelMapCore& surface_map,
                       std::span<const Feature> edges, std::span<const Feature> surfaces,
                       const Pose3f& start) {
  edge_map_ = &edge_map;
  surface_map_ = &surface_map;
  edges_ = edges;
  surfaces_ = surfaces;
  report_ = {};
  report_.solve.pose = start;
  guess_ = start;
  done_ = false;
  begin_round();
}

void MapMatcher::begin_round() {
  cursor_ = 0;
  plane_count_ = 0;
  line_count_ = 0;
  solving_ = false;
}

void MapMatcher::match(const Feature& feature, bool edge) {
  if (edge ? line_count_ == lines_.size() : plane_count_ == planes_.size()) { return; }
  std::array<Neighbour, kMaxNeighbours> storage;
  const std::span<Neighbour> found = std::span{storage}.first(config_.neighbours);
  const Vector3f q = transform(guess_, feature.point_m);
  const VoxelMapCore& map = edge ? *edge_map_ : *surface_map_;
  if (map.nearest(q, config_.search_m, found) < found.size()) { return; }
  if (edge) {
    if (const auto line = line_through(found, config_.line_slenderness)) {
      lines_[line_count_] = line_residual(feature.point_m, line->centre_m, line->direction);
      ++line_count_;
    }
  } else if (const auto plane = plane_through(found, config_.plane_thickness_m)) {
    planes_[plane_count_] = {feature.point_m, plane->centre_m, plane->direction};
    ++plane_count_;
  }
}

void MapMatcher::match_slice() {
  const std::size_t all = edges_.size() + surfaces_.size();
  const std::size_t end = std::min(all, cursor_ + config_.slice_features);
  for (; cursor_ < end; ++cursor_) {
    const bool edge = cursor_ < edges_.size();
    match(edge ? edges_[cursor_] : surfaces_[cursor_ - edges_.size()], edge);
  }
  if (cursor_ < all) { return; }
  solver_.begin({planes_.first(plane_count_), lines_.first(line_count_), guess_});
  solving_ = true;
}

void MapMatcher::finish_round() {
  const PoseSolveReport<float>& solved = solver_.report();
  const Vector3f shift = inline3::sub(solved.pose.translation_m, guess_.translation_m);
  const float turn_rad =
      rotation_angle_rad(compose(inverse(guess_.rotation), solved.pose.rotation));
  const float settled_m = config_.solver.converged_m;
  const float settled_rad = config_.solver.converged_rad;
  const bool settled = inline3::square(shift) < settled_m * settled_m && turn_rad < settled_rad;
  report_.solve = solved;
  report_.matched_edges = static_cast<std::uint32_t>(line_count_);
  report_.matched_surfaces = static_cast<std::uint32_t>(plane_count_);
  ++report_.rounds;
  guess_ = solved.pose;
  done_ = settled || report_.rounds == config_.rounds || !has_pose(solved.outcome);
  begin_round();
}

bool MapMatcher::step() {
  if (done_) { return true; }
  if (!solving_) {
    match_slice();
  } else if (solver_.step()) {
    finish_round();
  }
  return done_;
}

}  // namespace picolo::inline v0
