// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Finds features of the last scan near a place by ring and azimuth, instead of a kd-tree: a
/// counting sort builds it, a handful of bins answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/odometry/scan_features.hpp"

namespace picolo::inline v0 {

/// Which rings a search may look into, relative to a centre ring.
enum class RingChoice : std::uint8_t { near, same, other };

/// Over storage it does not own: `starts` holds rings * bins + 1 entries, `order` as many as
/// features. Context: one at a time.
class FeatureIndex {
 public:
  static constexpr std::size_t kNone = 0xFFFF;

  FeatureIndex(std::span<std::uint16_t> starts, std::span<std::uint16_t> order, std::size_t rings);

  /// `features` stay where they are until the next build. `full`: more than `order` holds.
  /// Cost: O(features + bins).
  Status build(std::span<const Feature> features);

  /// Index of the nearest feature within `radius_m` in rings at most `ring_reach` from `ring`: all
  /// of them (near), only `ring` itself (same), all but `ring` (other). `except` is left out. The
  /// first one on a tie; kNone when there is none. Cost: O(features in the bins within the radius).
  [[nodiscard]] std::size_t nearest(const Vector3f& p_m, std::size_t ring, std::size_t ring_reach,
                                    RingChoice choice, float radius_m, std::size_t except) const;
  [[nodiscard]] const Feature& operator[](std::size_t index) const { return features_[index]; }
  [[nodiscard]] std::size_t size() const { return features_.size(); }

 private:
  [[nodiscard]] std::size_t bin_of(const Vector3f& p_m) const;

  std::span<std::uint16_t> starts_;
  std::span<std::uint16_t> order_;
  std::size_t rings_;
  std::size_t bins_;
  std::span<const Feature> features_{};
};

}  // namespace picolo::inline v0
