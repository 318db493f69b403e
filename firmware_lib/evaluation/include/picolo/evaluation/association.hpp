// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which pose of one trajectory belongs to which of another: by stamp, or by interpolation at a
/// stamp. Context: any.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/evaluation/pose_error.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0 {

/// For every stamp of the shorter trajectory (of the reference when both are as long) the nearest
/// one of the other, if it is at most `max_difference_s` away; on a tie the earlier.
/// `estimate_offset_s` is added to the estimate's stamps. Stamps do not decrease, else
/// `invalid_argument`. Returns how many pairs (reference index, estimate index) were written;
/// `full` when `pairs` is shorter than the shorter trajectory. Cost: O(n log m).
[[nodiscard]] Result<std::size_t> associate(std::span<const double> reference_stamps_s,
                                            std::span<const double> estimate_stamps_s,
                                            double max_difference_s, double estimate_offset_s,
                                            std::span<IndexPair> pairs);

/// The pose at an instant between two stamped ones: position linear, rotation by slerp; never
/// extrapolates. `out_of_range` outside of the stamps, `invalid_argument` when the spans differ in
/// length. Cost: O(log n).
[[nodiscard]] Result<Transform3d> pose_at(std::span<const double> stamps_s,
                                          std::span<const Transform3d> poses, double stamp_s);

}  // namespace picolo::inline v0
