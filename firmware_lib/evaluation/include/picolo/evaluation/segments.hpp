// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The odometry measure of the KITTI benchmark (Geiger, Lenz, Urtasun 2012): drift over stretches
/// of 100 to 800 m.
/// Context: any.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kSegmentLengths = 8;

struct SegmentConfig {
  std::array<double, kSegmentLengths> lengths_m{100, 200, 300, 400, 500, 600, 700, 800};
  std::size_t step_frames = 10;  ///< a stretch begins at every so many poses
};

struct SegmentDrift {
  double translation_share{};  ///< m of error per m of way
  double rotation_rad_per_m{};
  std::size_t count{};  ///< stretches that were found
};

struct SegmentReport {
  std::array<SegmentDrift, kSegmentLengths> by_length{};
  SegmentDrift overall{};  ///< mean over all stretches
};

/// A stretch from pose i ends at the first pose whose way from i (along the reference) exceeds the
/// length. `path_scratch_m` is as long as both trajectories, else `invalid_argument`; `not_ready`
/// when the way is shorter than the shortest length. Cost: O(poses / step * 8 log poses).
[[nodiscard]] Result<SegmentReport> segment_errors(std::span<const Transform3d> reference,
                                                   std::span<const Transform3d> estimate,
                                                   const SegmentConfig& config,
                                                   std::span<double> path_scratch_m);

}  // namespace picolo::inline v0
