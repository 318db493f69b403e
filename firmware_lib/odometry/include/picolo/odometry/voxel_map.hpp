// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A map of points in space with fixed memory that follows the vehicle: a hash of cubes, a few
/// averaged points in each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/geometry/vector3.hpp"

namespace picolo::inline v0 {

/// A cube's place in units of its edge; +-32 km at 1 m.
struct VoxelKey {
  std::int16_t x{};
  std::int16_t y{};
  std::int16_t z{};
  [[nodiscard]] friend constexpr bool operator==(const VoxelKey&, const VoxelKey&) = default;
};

struct VoxelMapConfig {
  float voxel_m = 1.0F;
  float spacing_m = 0.2F;       ///< a point closer than this to one of its cube is averaged into it
  std::uint8_t max_weight = 3;  ///< of an average; then the newest point counts a third
  [[nodiscard]] constexpr bool valid() const {
    return voxel_m > 0.0F && spacing_m >= 0.0F && max_weight > 0;
  }
};

struct VoxelMapStorage {
  std::span<VoxelKey> keys;
  std::span<std::uint8_t> counts;                  ///< points in the cube; 0: free
  std::span<std::uint16_t> next;                   ///< the hash chain
  std::span<std::uint16_t> buckets;                ///< a power of two of them
  std::span<std::array<std::uint16_t, 3>> points;  ///< voxels x points a voxel, within the cube
  std::span<std::uint8_t> weights;                 ///< as many
};

struct VoxelMapCounters {
  std::uint32_t inserted = 0;
  std::uint32_t averaged = 0;
  std::uint32_t crowded = 0;  ///< not stored: the cube was full
  std::uint32_t refused = 0;  ///< not stored: no cube free, or outside of the map's coordinates
};

/// A map point found near a place, relative to the anchor.
struct Neighbour {
  Vector3f point_m{};
  float squared_m2{};
};

/// The logic, over storage it does not own. Coordinates are relative to `anchor`, a cube that moves
/// along with the vehicle: floats stay small however far it drives. Context: one at a time.
class VoxelMapCore {
 public:
  VoxelMapCore(const VoxelMapStorage& storage, const VoxelMapConfig& config);

  void clear();
  /// Cubes of map frame; whole cubes, so that moving it changes no stored bit.
  void set_anchor(VoxelKey anchor) { anchor_ = anchor; }
  [[nodiscard]] VoxelKey anchor() const { return anchor_; }

  /// Cost: O(points in a cube). False when not stored (see counters).
  bool insert(const Vector3f& anchor_p_m);
  /// Up to `found.size()` nearest points within `radius_m` <= voxel edge, nearest first; of equally
  /// near ones the first found. Cost: O(27 cubes).
  [[nodiscard]] std::size_t nearest(const Vector3f& anchor_p_m, float radius_m,
                                    std::span<Neighbour> found) const;
  /// Frees cubes farther than `radius_m` from the anchor's cube among the next `count` of the
  /// table; going round, so that the work a cycle is bounded.
  void prune(float radius_m, std::size_t count);

  [[nodiscard]] std::size_t voxels() const { return used_; }
  [[nodiscard]] std::size_t capacity() const { return storage_.keys.size(); }
  [[nodiscard]] const VoxelMapCounters& counters() const { return counters_; }
  [[nodiscard]] const VoxelMapConfig& config() const { return config_; }
  /// Points of cube `index` (for pictures), in metres of the map frame; returns how many.
  std::size_t points_of(std::size_t index, std::span<Vector3d> points_m) const;

 private:
  [[nodiscard]] std::size_t bucket_of(VoxelKey key) const;
  [[nodiscard]] std::uint16_t find(VoxelKey key) const;
  std::uint16_t find_or_make(VoxelKey key);
  void free_voxel(std::size_t index);

  VoxelMapStorage storage_;
  VoxelMapConfig config_;
  std::size_t per_voxel_;
  float step_m_;     ///< of a stored coordinate
  float inverse_m_;  ///< 1 / voxel edge
  VoxelKey anchor_{};
  std::uint16_t free_head_ = 0;
  std::size_t used_ = 0;
  std::size_t prune_at_ = 0;
  VoxelMapCounters counters_{};
};

/// Storage: Voxels * (10 + 7 * PointsPerVoxel) + 2 * Buckets bytes.
template <std::size_t Voxels, std::size_t PointsPerVoxel, std::size_t Buckets>
class VoxelMap {
  static_assert(Voxels > 0 && Voxels < 0xFFFF && PointsPerVoxel > 0 && PointsPerVoxel < 256);
  static_assert((Buckets & (Buckets - 1)) == 0 && Buckets > 0, "a power of two");

 public:
  explicit VoxelMap(const VoxelMapConfig& config)
      : core_({keys_, counts_, next_, buckets_, points_, weights_}, config) {}
  VoxelMap(const VoxelMap&) = delete;
  VoxelMap& operator=(const VoxelMap&) = delete;
  ~VoxelMap() = default;
  [[nodiscard]] VoxelMapCore& core() { return core_; }
  [[nodiscard]] const VoxelMapCore& core() const { return core_; }

 private:
  std::array<VoxelKey, Voxels> keys_{};
  std::array<std::uint8_t, Voxels> counts_{};
  std::array<std::uint16_t, Voxels> next_{};
  std::array<std::uint16_t, Buckets> buckets_{};
  std::array<std::array<std::uint16_t, 3>, Voxels * PointsPerVoxel> points_{};
  std::array<std::uint8_t, Voxels * PointsPerVoxel> weights_{};
  VoxelMapCore core_;
};

}  // namespace picolo::inline v0
