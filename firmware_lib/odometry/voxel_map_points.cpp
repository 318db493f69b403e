// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Apart from the map's own code: pictures want metres of the world, and double has no place in
// what runs per point.

#include "picolo/core/number_model.hpp"
#include "picolo/odometry/voxel_map.hpp"

namespace picolo::inline v0 {

std::size_t VoxelMapCore::points_of(std::size_t index, std::span<Vector3d> points_m) const {
  const VoxelKey key = storage_.keys[index];
  const std::size_t count =
      storage_.counts[index] < points_m.size() ? storage_.counts[index] : points_m.size();
  for (std::size_t k = 0; k < count; ++k) {
    const auto& s = storage_.points[index * per_voxel_ + k];
    const auto along = [&](std::int16_t cell, std::uint16_t step) {
      return (static_cast<double>(cell) + static_cast<double>(step) / 65536.0) *
             static_cast<double>(config_.voxel_m);
    };
    points_m[k] = {along(key.x, s[0]), along(key.y, s[1]), along(key.z, s[2])};
  }
  return count;
}

}  // namespace picolo::inline v0
