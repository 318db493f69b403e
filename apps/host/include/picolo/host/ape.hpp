// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Absolute pose error of a trajectory against a reference: the library's evaluation behind the
/// types of the tool.
#pragma once

#include <span>

#include "picolo/evaluation/statistics.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/trajectory.hpp"

namespace picolo::host {

/// Translation errors in metres after SE(2) alignment.
struct ApeSummary {
  ErrorStatistics statistics{};   ///< count 0: nothing could be compared, no figure means anything
  Pose2d reference_T_estimate{};  ///< the alignment: moves the estimate onto the reference
};

inline constexpr double kAssociationTolerance_s = 0.01;

/// Poses are paired by stamp, the nearest one at most the tolerance away, in whatever order the
/// stamps come. Positions that do not determine a rotation (a vehicle that stood still) are aligned
/// at the first pair.
[[nodiscard]] ApeSummary evaluate_ape(std::span<const TrajectoryPose> reference,
                                      std::span<const TrajectoryPose> estimate,
                                      double tolerance_s = kAssociationTolerance_s);

/// {"rmse", "mean", "median", "max", "pairs"}, metres; null when there are no pairs.
[[nodiscard]] Json to_json(const ApeSummary& ape);

/// The poses moved by `frame_T_poses`.
[[nodiscard]] Trajectory transformed(const Pose2d& frame_T_poses,
                                     std::span<const TrajectoryPose> poses);

}  // namespace picolo::host
