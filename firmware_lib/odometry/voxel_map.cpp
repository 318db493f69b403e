// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/voxel_map.hpp"

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/vector3_inline.hpp"

namespace picolo::inline v0 {
namespace {

using inline3::square;
using inline3::sub;

constexpr std::uint16_t kNone = 0xFFFF;
constexpr float kSteps = 65536.0F;  // of a coordinate within a cube

struct Cell {
  int x, y, z;  // relative to the anchor
};

/// Half of the range of keys: a place beyond is refused.
constexpr std::int32_t kLimit = 30000;

Cell cell_of(const Vector3f& p, float inverse_m) {
  return {floor_to_i32(p.x * inverse_m, -kLimit, kLimit),
          floor_to_i32(p.y * inverse_m, -kLimit, kLimit),
          floor_to_i32(p.z * inverse_m, -kLimit, kLimit)};
}

bool on_limit(int x) {
  return x <= -kLimit || x >= kLimit;
}

VoxelKey plus(VoxelKey anchor, Cell cell) {
  return {static_cast<std::int16_t>(anchor.x + cell.x),
          static_cast<std::int16_t>(anchor.y + cell.y),
          static_cast<std::int16_t>(anchor.z + cell.z)};
}

std::uint16_t stored(float along_m, float step_m) {
  return static_cast<std::uint16_t>(floor_to_i32(along_m / step_m, 0, 65535));
}

/// Squared distance of `p` from the cube.
float outside_m2(const Vector3f& p, Cell cell, float voxel_m) {
  const auto beyond = [voxel_m](float x, int at) {
    const float low = static_cast<float>(at) * voxel_m;
    const float high = low + voxel_m;
    return x < low ? low - x : (x > high ? x - high : 0.0F);
  };
  return square({beyond(p.x, cell.x), beyond(p.y, cell.y), beyond(p.z, cell.z)});
}

}  // namespace

VoxelMapCore::VoxelMapCore(const VoxelMapStorage& storage, const VoxelMapConfig& config)
    : storage_(storage),
      config_(config),
      per_voxel_(storage.points.size() / storage.keys.size()),
      step_m_(config.voxel_m / kSteps),
      inverse_m_(1.0F / config.voxel_m) {
  clear();
}

void VoxelMapCore::clear() {
  for (std::uint16_t& bucket : storage_.buckets) { bucket = kNone; }
  for (std::size_t i = 0; i < storage_.keys.size(); ++i) {
    storage_.counts[i] = 0;
    storage_.next[i] = i + 1 < storage_.keys.size() ? static_cast<std::uint16_t>(i + 1) : kNone;
  }
  free_head_ = 0;
  used_ = 0;
  prune_at_ = 0;
}

std::size_t VoxelMapCore::bucket_of(VoxelKey key) const {
  const std::uint32_t mixed = static_cast<std::uint16_t>(key.x) * 73856093U ^
                              static_cast<std::uint16_t>(key.y) * 19349669U ^
                              static_cast<std::uint16_t>(key.z) * 83492791U;
  return (mixed ^ (mixed >> 15U)) & (storage_.buckets.size() - 1);
}

std::uint16_t VoxelMapCore::find(VoxelKey key) const {
  std::uint16_t at = storage_.buckets[bucket_of(key)];
  while (at != kNone && !(storage_.keys[at] == key)) { at = storage_.next[at]; }
  return at;
}

std::uint16_t VoxelMapCore::find_or_make(VoxelKey key) {
  const std::uint16_t found = find(key);
  if (found != kNone || free_head_ == kNone) { return found; }
  const std::uint16_t fresh = free_head_;
  free_head_ = storage_.next[fresh];
  std::uint16_t& bucket = storage_.buckets[bucket_of(key)];
  storage_.keys[fresh] = key;
  storage_.counts[fresh] = 0;
  storage_.next[fresh] = bucket;
  bucket = fresh;
  ++used_;
  return fresh;
}

void VoxelMapCore::free_voxel(std::size_t index) {
  std::uint16_t* link = &storage_.buckets[bucket_of(storage_.keys[index])];
  while (*link != index) { link = &storage_.next[*link]; }
  *link = storage_.next[index];
  storage_.counts[index] = 0;
  storage_.next[index] = free_head_;
  free_head_ = static_cast<std::uint16_t>(index);
  --used_;
}

bool VoxelMapCore::insert(const Vector3f& p) {
  const Cell cell = cell_of(p, inverse_m_);
  if (on_limit(cell.x) || on_limit(cell.y) || on_limit(cell.z) || on_limit(anchor_.x + cell.x) ||
      on_limit(anchor_.y + cell.y) || on_limit(anchor_.z + cell.z)) {
    ++counters_.refused;
    return false;
  }
  const std::uint16_t voxel = find_or_make(plus(anchor_, cell));
  if (voxel == kNone) {
    ++counters_.refused;
    return false;
  }
  const Vector3f within{p.x - static_cast<float>(cell.x) * config_.voxel_m,
                        p.y - static_cast<float>(cell.y) * config_.voxel_m,
                        p.z - static_cast<float>(cell.z) * config_.voxel_m};
  const std::size_t first = voxel * per_voxel_;
  const std::size_t count = storage_.counts[voxel];
  const float near_m2 = config_.spacing_m * config_.spacing_m;
  for (std::size_t k = first; k < first + count; ++k) {
    auto& point = storage_.points[k];
    const Vector3f old{static_cast<float>(point[0]) * step_m_,
                       static_cast<float>(point[1]) * step_m_,
                       static_cast<float>(point[2]) * step_m_};
    if (square(sub(within, old)) > near_m2) { continue; }
    if (storage_.weights[k] < config_.max_weight) { ++storage_.weights[k]; }
    const float share = 1.0F / static_cast<float>(storage_.weights[k]);
    point = {stored(old.x + share * (within.x - old.x), step_m_),
             stored(old.y + share * (within.y - old.y), step_m_),
             stored(old.z + share * (within.z - old.z), step_m_)};
    ++counters_.averaged;
    return true;
  }
  if (count == per_voxel_) {
    ++counters_.crowded;
    return false;
  }
  storage_.points[first + count] = {stored(within.x, step_m_), stored(within.y, step_m_),
                                    stored(within.z, step_m_)};
  storage_.weights[first + count] = 1;
  storage_.counts[voxel] = static_cast<std::uint8_t>(count + 1);
  ++counters_.inserted;
  return true;
}

std::size_t VoxelMapCore::nearest(const Vector3f& p, float radius_m,
                                  std::span<Neighbour> found) const {
  const Cell centre = cell_of(p, inverse_m_);
  if (on_limit(centre.x) || on_limit(centre.y) || on_limit(centre.z)) { return 0; }
  std::size_t count = 0;
  float limit_m2 = radius_m * radius_m;
  // The own cube first: it usually settles how near the others must be.
  constexpr int kOrder[] = {0, -1, 1};
  for (const int dz : kOrder) {
    for (const int dy : kOrder) {
      for (const int dx : kOrder) {
        const Cell cell{centre.x + dx, centre.y + dy, centre.z + dz};
        if (outside_m2(p, cell, config_.voxel_m) >= limit_m2) { continue; }
        const std::uint16_t voxel = find(plus(anchor_, cell));
        if (voxel == kNone) { continue; }
        const Vector3f corner{static_cast<float>(cell.x) * config_.voxel_m,
                              static_cast<float>(cell.y) * config_.voxel_m,
                              static_cast<float>(cell.z) * config_.voxel_m};
        const std::size_t first = voxel * per_voxel_;
        for (std::size_t k = first; k < first + storage_.counts[voxel]; ++k) {
          const auto& s = storage_.points[k];
          const Vector3f at{corner.x + static_cast<float>(s[0]) * step_m_,
                            corner.y + static_cast<float>(s[1]) * step_m_,
                            corner.z + static_cast<float>(s[2]) * step_m_};
          const float m2 = square(sub(at, p));
          if (!(m2 < limit_m2)) { continue; }
          std::size_t place = count < found.size() ? count : found.size() - 1;
          count = place + 1;
          for (; place > 0 && m2 < found[place - 1].squared_m2; --place) {
            found[place] = found[place - 1];
          }
          found[place] = {at, m2};
          if (count == found.size()) { limit_m2 = found[count - 1].squared_m2; }
        }
      }
    }
  }
  return count;
}

void VoxelMapCore::prune(float radius_m, std::size_t count) {
  const float cells = radius_m * inverse_m_;
  for (std::size_t n = 0; n < count; ++n) {
    prune_at_ = prune_at_ + 1 < storage_.keys.size() ? prune_at_ + 1 : 0;
    if (storage_.counts[prune_at_] == 0) { continue; }
    const VoxelKey key = storage_.keys[prune_at_];
    const Vector3f way{static_cast<float>(key.x - anchor_.x), static_cast<float>(key.y - anchor_.y),
                       static_cast<float>(key.z - anchor_.z)};
    if (square(way) > cells * cells) { free_voxel(prune_at_); }
  }
}

}  // namespace picolo::inline v0
