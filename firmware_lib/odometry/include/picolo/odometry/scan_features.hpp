// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Edges and surfaces of one ring of a spinning 3D lidar (Zhang, Singh 2014, "LOAM", section V.A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/geometry/vector3.hpp"

namespace picolo::inline v0 {

/// One return, lidar frame. Returns of a ring come in the order of their azimuth.
struct RingPoint {
  Vector3f point_m{};
  float since_scan_start_s{};
};

/// A return that was chosen.
struct Feature {
  Vector3f point_m{};
  float since_scan_start_s{};
  std::uint8_t ring{};
  bool strong{};  ///< one of the few sharpest or flattest of its sector
};

/// Appends to storage it does not own; counts what did not fit.
class FeatureList {
 public:
  explicit FeatureList(std::span<Feature> storage) : storage_(storage) {}
  void clear() { size_ = 0; }
  bool add(const Feature& feature);
  [[nodiscard]] std::span<const Feature> view() const { return storage_.first(size_); }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

 private:
  std::span<Feature> storage_;
  std::size_t size_ = 0;
  std::uint32_t dropped_ = 0;
};

struct FeatureConfig {
  std::size_t sectors = 6;
  std::size_t strong_edges = 2;     ///< a sector: "sharp"
  std::size_t edges = 8;            ///< a sector: "less sharp", the sharp ones included
  std::size_t strong_surfaces = 4;  ///< a sector: "flat"
  std::size_t surfaces = 24;        ///< a sector: "less flat", the flat ones included
  float min_range_m = 2.0F;
  float max_range_m = 80.0F;
  /// Bend of a point: distance from the mean of its ten neighbours.
  float edge_bend_m = 0.06F;      ///< an edge bends more
  float edge_bend_share = 0.20F;  ///< and more than this share of the neighbours' mean distance
  float surface_bend_m = 0.05F;   ///< a surface bends less
  float depth_step_m = 0.3F;      ///< a larger step in range hides what is behind it: occlusion
  float parallel_share =
      0.02F;  ///< both steps larger than this share of the range: beam along the surface
  float azimuth_gap_rad = 0.02F;  ///< no return in between
  float surface_spacing_m = 0.3F;
  [[nodiscard]] constexpr bool valid() const {
    return sectors > 0 && strong_edges <= edges && strong_surfaces <= surfaces &&
           min_range_m >= 0.0F && max_range_m > min_range_m && edge_bend_m > 0.0F &&
           surface_bend_m > 0.0F && depth_step_m > 0.0F && azimuth_gap_rad > 0.0F &&
           surface_spacing_m > 0.0F;
  }
};

/// Work space for one ring: 11 bytes a return.
struct FeatureScratch {
  std::span<float> range_m;
  std::span<float> bend_m;
  std::span<std::uint16_t> order;
  std::span<std::uint8_t> flags;
};

/// Finds the features of one ring and appends them. Returns that are not finite or out of range end
/// a neighbourhood as a gap does. `full`: the ring is longer than the scratch; nothing was added.
/// `invalid_argument`: bad configuration. Cost: O(returns), about 150 instructions each. Context:
/// one at a time.
Status find_features(std::span<const RingPoint> ring_points, std::uint8_t ring,
                     const FeatureConfig& config, const FeatureScratch& scratch, FeatureList& edges,
                     FeatureList& surfaces);

}  // namespace picolo::inline v0
