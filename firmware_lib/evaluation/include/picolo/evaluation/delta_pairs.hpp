// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which pairs of instants a relative error compares: those that lie a given way apart. Context:
/// any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/evaluation/pose_error.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0 {

enum class DeltaUnit : std::uint8_t { frames, metres, degrees, radians };

struct DeltaConfig {
  double delta = 1.0;
  DeltaUnit unit = DeltaUnit::frames;
  /// false: consecutive pairs, each begins where the last one ended. true: every pair that is
  /// `delta` apart; for metres the nearest partner of every pose, for angles every pair, both
  /// within `relative_tolerance`.
  bool all_pairs = false;
  double relative_tolerance = 0.1;
  [[nodiscard]] constexpr bool valid() const {
    return delta > 0.0 && relative_tolerance >= 0.0 && (unit != DeltaUnit::frames || delta >= 1.0);
  }
};

/// Fills `pairs` in the order of their first index and returns how many there are.
/// `path_scratch` is as long as `poses` when unit is metres and all_pairs is set, else it may be
/// empty. `invalid_argument` for a bad configuration or short scratch; `full` when `pairs` is too
/// short (as many as poses always suffice, except for angles with all_pairs, where n (n - 1) / 2
/// do).
/// Cost: O(poses); with all_pairs O(poses log poses) for metres, O(poses^2) for angles.
[[nodiscard]] Result<std::size_t> select_pairs(std::span<const Transform3d> poses,
                                               const DeltaConfig& config,
                                               std::span<double> path_scratch,
                                               std::span<IndexPair> pairs);

/// path_m[i] = length of the way from pose 0 to pose i; both spans have one length. Cost: O(poses).
Status accumulate_path(std::span<const Transform3d> poses, std::span<double> path_m);

}  // namespace picolo::inline v0
