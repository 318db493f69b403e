// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Odometry of a spinning 3D lidar from edges and surfaces (Zhang, Singh 2014, "LOAM: lidar
/// odometry and mapping in real-time"): scan to scan, then scan to a rolling map; all memory
/// inside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/geometry/se3.hpp"
#include "picolo/odometry/feature_index.hpp"
#include "picolo/odometry/map_matcher.hpp"
#include "picolo/odometry/scan_features.hpp"
#include "picolo/odometry/voxel_map.hpp"
#include "picolo/solve/pose_solver.hpp"

namespace picolo::inline v0 {

struct LoamConfig {
  FeatureConfig features{};
  VoxelMapConfig map{};
  MapMatcherConfig map_match{};
  bool compensated = false;    ///< the points are undistorted already
  float scan_period_s = 0.1F;  ///< of the motion that undistortion spreads over a scan
  int scan_rounds = 2;         ///< associations with the last scan; 0: constant velocity only
  float scan_search_m = 2.0F;
  float insert_range_m = 60.0F;      ///< farther features do not enter the map
  float map_radius_m = 70.0F;        ///< cubes beyond are freed
  std::size_t slice_features = 256;  ///< work of one `step`
  PoseSolverConfig scan_solver{.plane_kernel = {.kind = RobustKind::geman_mcclure, .width = 1.0F},
                               .line_kernel = {.kind = RobustKind::geman_mcclure, .width = 0.15F},
                               .max_iterations = 5,
                               .min_residuals = 30,
                               .converged_m = 5e-4F,
                               .converged_rad = 2e-5F};
  [[nodiscard]] constexpr bool valid() const {
    return features.valid() && map.valid() && map_match.valid() && scan_solver.valid() &&
           scan_period_s > 0.0F && scan_rounds >= 0 && scan_search_m > 0.0F &&
           map_match.search_m <= map.voxel_m && insert_range_m > 0.0F &&
           map_radius_m > insert_range_m && slice_features > 0;
  }
};

struct LoamReport {
  Pose3d map_T_lidar{};   ///< at the end of the scan (of compensated data: at its reference)
  Pose3d last_T_lidar{};  ///< motion since the scan before
  SolveOutcome scan_outcome = SolveOutcome::too_few_residuals;
  SolveOutcome map_outcome = SolveOutcome::too_few_residuals;
  std::array<float, 36> covariance{};  ///< of map_T_lidar given the map: (rotation, translation)
  int degenerate_directions = 0;
  std::uint32_t scans = 0;
  std::uint32_t edges = 0;  ///< of this scan
  std::uint32_t surfaces = 0;
  std::uint32_t matched_edges = 0;  ///< in the last round
  std::uint32_t matched_surfaces = 0;
  std::uint32_t dropped_features = 0;  ///< since the start: storage was full
  std::uint32_t skipped_rings = 0;     ///< since the start: too long, or not a ring of this lidar
};

/// Storage of `LoamCore`; see `LoamOdometry` for the sizes.
struct LoamStorage {
  FeatureScratch scratch;
  std::span<Feature> edges, surfaces, last_edges, last_surfaces;
  std::span<std::uint16_t> edge_starts, edge_order, surface_starts, surface_order;
  std::span<PlaneResidual<float>> planes;
  std::span<LineResidual<float>> lines;
  std::size_t rings;
};

/// The logic. One scan is: `begin_scan`, `add_ring` for each ring as it arrives (1/16 of the work
/// of extraction each), then `step` until it returns true, then `report`. Every call is bounded by
/// a ring's returns or by `slice_features`. Context: one at a time. No heap; 3 KiB of stack.
class LoamCore {
 public:
  LoamCore(const LoamStorage& storage, VoxelMapCore& edge_map, VoxelMapCore& surface_map,
           const LoamConfig& config);

  void reset();
  void begin_scan();
  /// Returns as `find_features`; `out_of_range`: no such ring. A ring that is refused is counted,
  /// the scan goes on without it, so incomplete scans are survived.
  Status add_ring(std::size_t ring, std::span<const RingPoint> points);
  /// One slice; true when the report is final.
  bool step();
  [[nodiscard]] const LoamReport& report() const { return report_; }
  /// The features of the last finished scan, at its reference instant, lidar frame.
  [[nodiscard]] std::span<const Feature> edges() const { return last_edges_; }
  [[nodiscard]] std::span<const Feature> surfaces() const { return last_surfaces_; }

 private:
  enum class Stage : std::uint8_t {
    gather,
    scan_match,
    scan_solve,
    undistort,
    map_match,
    insert,
    index,
    done
  };

  [[nodiscard]] Vector3f at_reference(const Feature& feature) const;
  [[nodiscard]] Pose3f local_pose() const;
  void begin_round(Stage stage);
  void predict();
  void match_slice_with_scan();
  void match_with_scan(const Feature& feature, bool edge);
  void finish_scan_round();
  void begin_map_match();
  void finish_map_match();
  void undistort_slice();
  void insert_slice();
  void finish();

  LoamStorage storage_;
  VoxelMapCore& edge_map_;
  VoxelMapCore& surface_map_;
  LoamConfig config_;
  PoseSolver<float> scan_solver_;
  MapMatcher map_matcher_;
  FeatureList edges_;
  FeatureList surfaces_;
  FeatureIndex edge_index_;
  FeatureIndex surface_index_;
  std::span<const Feature> last_edges_{};
  std::span<const Feature> last_surfaces_{};
  LoamReport report_{};
  Pose3f motion_{};  ///< last_T_lidar, the present estimate
  Pose3f guess_{};   ///< of the round: last_T_lidar or anchor_T_lidar
  Pose3d map_T_last_{};
  std::size_t cursor_ = 0;
  std::size_t planes_ = 0;
  std::size_t lines_ = 0;
  int round_ = 0;
  Stage stage_ = Stage::done;
};

/// Storage of one odometry. `memory_bytes` is all there is, the map included.
template <std::size_t Rings = 16, std::size_t RingPoints = 2304, std::size_t Edges = 768,
          std::size_t Surfaces = 2304, std::size_t EdgeVoxels = 1280, std::size_t EdgePoints = 6,
          std::size_t SurfaceVoxels = 6144, std::size_t SurfacePoints = 8,
          std::size_t AzimuthBins = 60>
class LoamOdometry {
 public:
  explicit LoamOdometry(const LoamConfig& config)
      : edge_map_(config.map),
        surface_map_(config.map),
        core_(storage(), edge_map_.core(), surface_map_.core(), config) {}
  LoamOdometry(const LoamOdometry&) = delete;
  LoamOdometry& operator=(const LoamOdometry&) = delete;
  ~LoamOdometry() = default;

  [[nodiscard]] LoamCore& core() { return core_; }
  [[nodiscard]] const VoxelMapCore& edge_map() const { return edge_map_.core(); }
  [[nodiscard]] const VoxelMapCore& surface_map() const { return surface_map_.core(); }
  [[nodiscard]] static constexpr std::size_t memory_bytes() { return sizeof(LoamOdometry); }
  [[nodiscard]] static constexpr std::size_t map_bytes() {
    return sizeof(EdgeMap) + sizeof(SurfaceMap);
  }

 private:
  using EdgeMap = VoxelMap<EdgeVoxels, EdgePoints, 2048>;
  using SurfaceMap = VoxelMap<SurfaceVoxels, SurfacePoints, 8192>;

  LoamStorage storage() {
    return {{range_m_, bend_m_, order_, flags_},
            edges_,
            surfaces_,
            last_edges_,
            last_surfaces_,
            edge_starts_,
            edge_order_,
            surface_starts_,
            surface_order_,
            planes_,
            lines_,
            Rings};
  }

  std::array<float, RingPoints> range_m_{};
  std::array<float, RingPoints> bend_m_{};
  std::array<std::uint16_t, RingPoints> order_{};
  std::array<std::uint8_t, RingPoints> flags_{};
  std::array<Feature, Edges> edges_{};
  std::array<Feature, Surfaces> surfaces_{};
  std::array<Feature, Edges> last_edges_{};
  std::array<Feature, Surfaces> last_surfaces_{};
  std::array<std::uint16_t, Rings * AzimuthBins + 1> edge_starts_{};
  std::array<std::uint16_t, Rings * AzimuthBins + 1> surface_starts_{};
  std::array<std::uint16_t, Edges> edge_order_{};
  std::array<std::uint16_t, Surfaces> surface_order_{};
  std::array<PlaneResidual<float>, Surfaces> planes_{};
  std::array<LineResidual<float>, Edges> lines_{};
  EdgeMap edge_map_;
  SurfaceMap surface_map_;
  LoamCore core_;
};

}  // namespace picolo::inline v0
