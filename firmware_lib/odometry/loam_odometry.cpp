// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The pipeline of one scan, stage by stage:
//   gather      features of each ring as it arrives
//   scan_match  strong features against the last scan, then solve: last_T_lidar
//   undistort   every feature to the reference instant with that motion
//   map_match   all features against the map, then solve: map_T_lidar
//   insert      features into the map, cubes that are left behind out of it
//   index       this scan becomes the last one

#include "picolo/odometry/loam_odometry.hpp"

#include <algorithm>

#include "local_shape.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/vector3_inline.hpp"

namespace picolo::inline v0 {
namespace {

using inline3::cross3;
using inline3::Mover;
using inline3::square;
using inline3::sub;

constexpr std::size_t kRingReach = 2;

Vector3d anchor_m(VoxelKey anchor, float voxel_m) {
  const auto edge_m = static_cast<double>(voxel_m);
  return {anchor.x * edge_m, anchor.y * edge_m, anchor.z * edge_m};
}

VoxelKey cube_of(const Vector3d& p, float voxel_m) {
  const auto along = [voxel_m](double x) {
    return static_cast<std::int16_t>(floor_to_i32(x / static_cast<double>(voxel_m), -30000, 30000));
  };
  return {along(p.x), along(p.y), along(p.z)};
}

}  // namespace

LoamCore::LoamCore(const LoamStorage& storage, VoxelMapCore& edge_map, VoxelMapCore& surface_map,
                   const LoamConfig& config)
    : storage_(storage),
      edge_map_(edge_map),
      surface_map_(surface_map),
      config_(config),
      scan_solver_(config.scan_solver),
      map_matcher_(config.map_match, storage.planes, storage.lines),
      edges_(storage.edges),
      surfaces_(storage.surfaces),
      edge_index_(storage.edge_starts, storage.edge_order, storage.rings),
      surface_index_(storage.surface_starts, storage.surface_order, storage.rings) {}

void LoamCore::reset() {
  edge_map_.clear();
  surface_map_.clear();
  last_edges_ = {};
  last_surfaces_ = {};
  report_ = {};
  motion_ = {};
  guess_ = {};
  map_T_last_ = {};
  edge_map_.set_anchor({});
  surface_map_.set_anchor({});
  stage_ = Stage::done;
}

void LoamCore::begin_scan() {
  edges_.clear();
  surfaces_.clear();
  stage_ = Stage::gather;
}

Status LoamCore::add_ring(std::size_t ring, std::span<const RingPoint> points) {
  if (stage_ != Stage::gather) { return Status::not_ready; }
  Status status = Status::out_of_range;
  if (ring < storage_.rings) {
    status = find_features(points, static_cast<std::uint8_t>(ring), config_.features,
                           storage_.scratch, edges_, surfaces_);
  }
  if (status != Status::ok) { ++report_.skipped_rings; }
  return status;
}

/// Where the feature would have been seen from the pose at the end of the scan, with the present
/// estimate of the motion spread evenly over the scan.
Vector3f LoamCore::at_reference(const Feature& feature) const {
  if (config_.compensated) { return feature.point_m; }
  const float share =
      std::clamp(1.0F - feature.since_scan_start_s / config_.scan_period_s, 0.0F, 1.0F);
  return transform(interpolate(Pose3f{}, inverse(motion_), share), feature.point_m);
}

Pose3f LoamCore::local_pose() const {
  const Pose3d pose = map_T_last_ * to_f64(motion_);
  const Vector3d origin = anchor_m(surface_map_.anchor(), config_.map.voxel_m);
  return to_f32(Pose3d{pose.rotation, difference(pose.translation_m, origin)});
}

/// Constant velocity: the motion of the last scan is this one's start.
void LoamCore::predict() {
  report_.edges = static_cast<std::uint32_t>(edges_.size());
  report_.surfaces = static_cast<std::uint32_t>(surfaces_.size());
  report_.dropped_features = edges_.dropped() + surfaces_.dropped();
  report_.scan_outcome = SolveOutcome::too_few_residuals;
  report_.map_outcome = SolveOutcome::too_few_residuals;
  report_.covariance = {};
  round_ = 0;
  const bool first = report_.scans == 0;
  begin_round(first                     ? Stage::insert
              : config_.scan_rounds > 0 ? Stage::scan_match
                                        : Stage::undistort);
}

void LoamCore::begin_round(Stage stage) {
  if (stage == Stage::scan_match) { guess_ = motion_; }
  cursor_ = 0;
  planes_ = 0;
  lines_ = 0;
  stage_ = stage;
}

/// A line through the nearest edge and its neighbour in another ring; a plane through the nearest
/// surface, one beside it in its ring and one in another.
void LoamCore::match_with_scan(const Feature& feature, bool edge) {
  if (!feature.strong) { return; }
  const Vector3f p = at_reference(feature);
  const Vector3f q = transform(guess_, p);
  const FeatureIndex& index = edge ? edge_index_ : surface_index_;
  const float radius_m = config_.scan_search_m;
  const std::size_t j =
      index.nearest(q, feature.ring, kRingReach, RingChoice::near, radius_m, FeatureIndex::kNone);
  if (j == FeatureIndex::kNone) { return; }
  const std::size_t other =
      index.nearest(q, index[j].ring, kRingReach, RingChoice::other, radius_m, j);
  if (other == FeatureIndex::kNone) { return; }
  if (edge) {
    storage_.lines[lines_] =
        line_residual(p, index[j].point_m, sub(index[other].point_m, index[j].point_m));
    ++lines_;
    return;
  }
  const std::size_t beside = index.nearest(q, index[j].ring, 0, RingChoice::same, radius_m, j);
  if (beside == FeatureIndex::kNone) { return; }
  const auto normal = local_shape::unit(cross3(sub(index[other].point_m, index[j].point_m),
                                               sub(index[beside].point_m, index[j].point_m)));
  if (!normal) { return; }
  storage_.planes[planes_] = {p, index[j].point_m, *normal};
  ++planes_;
}

void LoamCore::match_slice_with_scan() {
  const std::size_t all = edges_.size() + surfaces_.size();
  const std::size_t end = std::min(all, cursor_ + config_.slice_features);
  for (; cursor_ < end; ++cursor_) {
    const bool edge = cursor_ < edges_.size();
    match_with_scan(edge ? edges_.view()[cursor_] : surfaces_.view()[cursor_ - edges_.size()],
                    edge);
  }
  if (cursor_ < all) { return; }
  scan_solver_.begin({storage_.planes.first(planes_), storage_.lines.first(lines_), guess_});
  stage_ = Stage::scan_solve;
}

void LoamCore::finish_scan_round() {
  report_.scan_outcome = scan_solver_.report().outcome;
  const bool usable = has_pose(report_.scan_outcome);
  if (usable) { motion_ = scan_solver_.report().pose; }
  ++round_;
  begin_round(usable && round_ < config_.scan_rounds ? Stage::scan_match : Stage::undistort);
}

void LoamCore::undistort_slice() {
  const std::size_t all = edges_.size() + surfaces_.size();
  const std::size_t end =
      config_.compensated ? all : std::min(all, cursor_ + config_.slice_features);
  for (; cursor_ < end && !config_.compensated; ++cursor_) {
    Feature& feature = cursor_ < edges_.size() ? storage_.edges[cursor_]
                                               : storage_.surfaces[cursor_ - edges_.size()];
    feature.point_m = at_reference(feature);
  }
  if (end == all) { begin_map_match(); }
}

void LoamCore::begin_map_match() {
  const Pose3d start = map_T_last_ * to_f64(motion_);
  const VoxelKey anchor = cube_of(start.translation_m, config_.map.voxel_m);
  edge_map_.set_anchor(anchor);
  surface_map_.set_anchor(anchor);
  guess_ = local_pose();
  map_matcher_.begin(edge_map_, surface_map_, edges_.view(), surfaces_.view(), guess_);
  begin_round(Stage::map_match);
}

void LoamCore::finish_map_match() {
  const MapMatchReport& match = map_matcher_.report();
  report_.map_outcome = match.solve.outcome;
  report_.matched_edges = match.matched_edges;
  report_.matched_surfaces = match.matched_surfaces;
  report_.covariance = match.solve.covariance;
  report_.degenerate_directions = match.solve.degenerate_directions;
  guess_ = match.solve.pose;  // the start itself when there was no answer
  begin_round(Stage::insert);
}

void LoamCore::insert_slice() {
  const std::size_t all = edges_.size() + surfaces_.size();
  const std::size_t end = std::min(all, cursor_ + config_.slice_features);
  const Mover mover{guess_};
  const float range_m2 = config_.insert_range_m * config_.insert_range_m;
  for (; cursor_ < end; ++cursor_) {
    const bool edge = cursor_ < edges_.size();
    const Feature& feature =
        edge ? edges_.view()[cursor_] : surfaces_.view()[cursor_ - edges_.size()];
    if (square(feature.point_m) > range_m2) { continue; }
    (void)(edge ? edge_map_ : surface_map_).insert(mover(feature.point_m));
  }
  edge_map_.prune(config_.map_radius_m, config_.slice_features);
  surface_map_.prune(config_.map_radius_m, config_.slice_features);
  if (cursor_ == all) { stage_ = Stage::index; }
}

/// The scan's pose is settled: it becomes the last scan.
void LoamCore::finish() {
  const Vector3d origin = anchor_m(surface_map_.anchor(), config_.map.voxel_m);
  const Pose3d local = to_f64(guess_);
  const Pose3d map_T_lidar{normalised(local.rotation), sum(local.translation_m, origin)};
  report_.map_T_lidar = map_T_lidar;
  report_.last_T_lidar = between(map_T_last_, map_T_lidar);
  map_T_last_ = map_T_lidar;
  motion_ = to_f32(report_.last_T_lidar);
  std::copy_n(storage_.edges.begin(), edges_.size(), storage_.last_edges.begin());
  std::copy_n(storage_.surfaces.begin(), surfaces_.size(), storage_.last_surfaces.begin());
  last_edges_ = storage_.last_edges.first(edges_.size());
  last_surfaces_ = storage_.last_surfaces.first(surfaces_.size());
  (void)edge_index_.build(last_edges_);
  (void)surface_index_.build(last_surfaces_);
  ++report_.scans;
  stage_ = Stage::done;
}

bool LoamCore::step() {
  switch (stage_) {
    case Stage::gather: predict(); break;
    case Stage::scan_match: match_slice_with_scan(); break;
    case Stage::scan_solve:
      if (scan_solver_.step()) { finish_scan_round(); }
      break;
    case Stage::undistort: undistort_slice(); break;
    case Stage::map_match:
      if (map_matcher_.step()) { finish_map_match(); }
      break;
    case Stage::insert: insert_slice(); break;
    case Stage::index: finish(); break;
    case Stage::done: break;
  }
  return stage_ == Stage::done;
}

}  // namespace picolo::inline v0
