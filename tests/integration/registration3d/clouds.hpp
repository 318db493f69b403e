// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Registers whole clouds with the library's map matcher.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include "picolo/odometry/map_matcher.hpp"

namespace picolo::test {

using Cloud = std::vector<Vector3f>;

/// One point a cube, so that what is near does not outvote what is far.
inline std::vector<Feature> features_of(const Cloud& cloud, float cube_m) {
  std::set<std::array<int, 3>> taken;
  std::vector<Feature> features;
  for (const Vector3f& p : cloud) {
    const auto place = [cube_m](float x) { return static_cast<int>(std::floor(x / cube_m)); };
    if (taken.insert({place(p.x), place(p.y), place(p.z)}).second) {
      features.push_back({p, 0.0F, 0, false});
    }
  }
  return features;
}

/// target_T_source, from coarse to fine: large cubes first, so that the start may be far off.
inline Pose3f registered(const Cloud& target_edges, const Cloud& target_surfaces,
                         const Cloud& source_edges, const Cloud& source_surfaces) {
  struct Level {
    float voxel_m, spacing_m, thickness_m;
  };
  using Map = VoxelMap<60000, 20, 65536>;
  Pose3f pose;
  const auto edges = features_of(source_edges, 0.2F);
  const auto surfaces = features_of(source_surfaces, 0.3F);
  std::vector<PlaneResidual<float>> planes(surfaces.size());
  std::vector<LineResidual<float>> lines(edges.size());
  for (const Level level : {Level{3.0F, 0.4F, 0.3F}, {1.5F, 0.2F, 0.15F}, {1.0F, 0.1F, 0.08F}}) {
    const VoxelMapConfig config{.voxel_m = level.voxel_m, .spacing_m = level.spacing_m};
    const auto edge_map = std::make_unique<Map>(config);
    const auto surface_map = std::make_unique<Map>(config);
    for (const auto& p : target_edges) { (void)edge_map->core().insert(p); }
    for (const auto& p : target_surfaces) { (void)surface_map->core().insert(p); }
    MapMatcherConfig matcher_config{.rounds = 20,
                                    .search_m = level.voxel_m,
                                    .neighbours = 8,
                                    .plane_thickness_m = level.thickness_m,
                                    .line_slenderness = 10.0F};
    matcher_config.solver.plane_kernel.width = level.voxel_m / 2;
    matcher_config.solver.line_kernel.width = level.voxel_m / 4;
    MapMatcher matcher{matcher_config, planes, lines};
    matcher.begin(edge_map->core(), surface_map->core(), edges, surfaces, pose);
    while (!matcher.step()) {}
    pose = matcher.report().solve.pose;
  }
  return pose;
}

struct PoseError {
  double distance_m;
  double angle_deg;
};

inline PoseError error_of(const Pose3f& pose, const Pose3d& truth) {
  const Pose3d e = between(truth, to_f64(pose));
  return {norm(e.translation_m), rotation_angle_rad(e.rotation) * 57.29577951308232};
}

}  // namespace picolo::test
