// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The errors of single poses (APE) and of single motions (RPE), as Sturm et al. 2012 define them
/// and evo computes them. Spans in, numbers out: no file I/O, no storage of its own. Double
/// precision: evaluation is on the double list.
/// Context: any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0 {

/// What of the error transform E is measured.
enum class PoseRelation : std::uint8_t {
  translation,   ///< |translation of E| in m
  rotation_rad,  ///< rotation angle of E in rad
  rotation_deg,  ///< rotation angle of E in degrees
  full,          ///< Frobenius norm of E - I, dimensionless (mixes m and rotation)
};

/// Indices of two poses of one trajectory, `first` before `second`; or of two trajectories.
struct IndexPair {
  std::uint32_t first{};
  std::uint32_t second{};
  [[nodiscard]] friend constexpr bool operator==(const IndexPair&, const IndexPair&) = default;
};

/// E = estimate^-1 * reference. Cost: O(1).
[[nodiscard]] double absolute_error(const Transform3d& reference, const Transform3d& estimate,
                                    PoseRelation relation);

/// E = (reference motion)^-1 * (estimated motion) between two instants. Cost: O(1).
[[nodiscard]] double relative_error(const Transform3d& reference_from,
                                    const Transform3d& reference_to,
                                    const Transform3d& estimate_from,
                                    const Transform3d& estimate_to, PoseRelation relation);

/// Errors of all poses. `errors` has the length of both trajectories, which is not zero; otherwise
/// `invalid_argument`.
/// Cost: O(poses).
Status absolute_errors(std::span<const Transform3d> reference,
                       std::span<const Transform3d> estimate, PoseRelation relation,
                       std::span<double> errors);

/// Errors of the motions named by `pairs`; `errors` is as long as `pairs`. An index beyond a
/// trajectory is `out_of_range`.
Status relative_errors(std::span<const Transform3d> reference,
                       std::span<const Transform3d> estimate, std::span<const IndexPair> pairs,
                       PoseRelation relation, std::span<double> errors);

}  // namespace picolo::inline v0
