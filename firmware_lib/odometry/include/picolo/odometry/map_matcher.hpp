// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Registers edges and surfaces with voxel maps: lines and planes through the nearest map points,
/// associated anew in a few rounds, each followed by a robust solve.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/odometry/scan_features.hpp"
#include "picolo/odometry/voxel_map.hpp"
#include "picolo/solve/pose_solver.hpp"

namespace picolo::inline v0 {

struct MapMatcherConfig {
  int rounds = 3;                    ///< associations at most
  float search_m = 1.0F;             ///< not beyond the maps' cube edge
  std::size_t neighbours = 5;        ///< of a line or plane, 3 to 8
  float plane_thickness_m = 0.08F;   ///< no neighbour is farther off the plane
  float line_slenderness = 50.0F;    ///< spread along over spread across
  std::size_t slice_features = 256;  ///< work of one `step`
  PoseSolverConfig solver{.plane_kernel = {.kind = RobustKind::geman_mcclure, .width = 1.0F},
                          .line_kernel = {.kind = RobustKind::geman_mcclure, .width = 0.15F},
                          .max_iterations = 5,
                          .min_residuals = 30,
                          .converged_m = 5e-4F,
                          .converged_rad = 2e-5F};
  [[nodiscard]] constexpr bool valid() const {
    return rounds > 0 && search_m > 0.0F && neighbours >= 3 && neighbours <= 8 &&
           plane_thickness_m > 0.0F && line_slenderness > 1.0F && slice_features > 0 &&
           solver.valid();
  }
};

struct MapMatchReport {
  PoseSolveReport<float> solve{};  ///< of the last round; pose: anchor_T_features
  int rounds = 0;
  std::uint32_t matched_edges = 0;  ///< in the last round
  std::uint32_t matched_surfaces = 0;
};

/// True for outcomes that carry a pose of their own.
[[nodiscard]] bool has_pose(SolveOutcome outcome);

/// `begin`, `step` until it returns true, `report`. Works on correspondences that it does not own:
/// features beyond their number are not used. Context: one at a time. Cost of a step:
/// `slice_features` searches, or one pass over the correspondences.
class MapMatcher {
 public:
  MapMatcher(const MapMatcherConfig& config, std::span<PlaneResidual<float>> planes,
             std::span<LineResidual<float>> lines)
      : config_(config), planes_(planes), lines_(lines), solver_(config.solver) {}

  /// Maps and features stay valid until the report. `start`: anchor_T_features.
  void begin(const VoxelMapCore& edge_map, const VoxelMapCore& surface_map,
             std::span<const Feature> edges, std::span<const Feature> surfaces,
             const Pose3f& start);
  bool step();
  [[nodiscard]] const MapMatchReport& report() const { return report_; }

 private:
  void match_slice();
  void match(const Feature& feature, bool edge);
  void begin_round();
  void finish_round();

  MapMatcherConfig config_;
  std::span<PlaneResidual<float>> planes_;
  std::span<LineResidual<float>> lines_;
  PoseSolver<float> solver_;
  const VoxelMapCore* edge_map_ = nullptr;
  const VoxelMapCore* surface_map_ = nullptr;
  std::span<const Feature> edges_{};
  std::span<const Feature> surfaces_{};
  MapMatchReport report_{};
  Pose3f guess_{};
  std::size_t cursor_ = 0;
  std::size_t plane_count_ = 0;
  std::size_t line_count_ = 0;
  bool solving_ = false;
  bool done_ = true;
};

}  // namespace picolo::inline v0
