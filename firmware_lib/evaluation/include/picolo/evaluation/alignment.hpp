// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Brings an estimate into the frame of its reference before the errors are taken. Context: any.
#pragma once

#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0 {

enum class AlignmentKind : std::uint8_t {
  none,
  origin,  ///< the first poses coincide
  se2,     ///< least squares over the x y positions: yaw and a shift in the plane; heights stay
  se3,     ///< least squares over the positions: rotation and shift (Umeyama 1991)
  sim3,    ///< and scale, as monocular estimates need
};

/// reference_p = scale * rotation * estimate_p + translation.
struct Alignment {
  Transform3d motion{};
  double scale = 1.0;
};

/// Least-squares alignment. Both spans have one length, two poses at least (three not on one line
/// for se3 and sim3). `invalid_argument` otherwise, `degenerate` when the positions do not
/// determine the answer. Cost: O(poses).
[[nodiscard]] Result<Alignment> find_alignment(std::span<const Transform3d> reference,
                                               std::span<const Transform3d> estimate,
                                               AlignmentKind kind);

/// The pose in the reference's frame: scale acts on its position, then the motion on the whole
/// pose. Cost: O(1).
[[nodiscard]] Transform3d aligned(const Alignment& alignment, const Transform3d& pose);
/// In place, all poses.
void align(const Alignment& alignment, std::span<Transform3d> poses);

}  // namespace picolo::inline v0
