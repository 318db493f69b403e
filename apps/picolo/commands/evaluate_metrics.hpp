// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What `picolo evaluate` computes: two files' trajectories associated, aligned and compared with
/// the library's evaluation.
#pragma once

#include <string>
#include <vector>

#include "picolo/evaluation/alignment.hpp"
#include "picolo/evaluation/delta_pairs.hpp"
#include "picolo/evaluation/pose_error.hpp"
#include "picolo/evaluation/segments.hpp"
#include "picolo/evaluation/statistics.hpp"
#include "picolo/host/spatial_trajectory.hpp"

namespace picolo::tool {

struct EvaluateSettings {
  AlignmentKind alignment = AlignmentKind::none;
  PoseRelation relation = PoseRelation::translation;
  DeltaConfig delta{};
  double max_difference_s = 0.01;
  double offset_s = 0.0;  ///< added to the stamps of the estimate
  bool interpolate =
      false;  ///< the reference at the estimate's stamps, instead of the nearest pose
};

/// Two trajectories of one length, pose by pose.
struct PosePairs {
  std::vector<double> stamps_s;  ///< of the estimate; pose numbers when the files have none
  bool stamped = false;
  std::vector<Transform3d> reference;
  std::vector<Transform3d> estimate;
};

struct EvaluateResult {
  ErrorStatistics statistics{};
  Alignment alignment{};
  std::vector<double> errors;  ///< in the order of the poses
  std::vector<double> stamps_s;
  std::vector<Transform3d> at;  ///< the estimate's poses that the errors belong to
};

/// Throws host::UserError (input) when there is nothing to compare.
[[nodiscard]] PosePairs paired(const host::SpatialTrajectory& reference,
                               const host::SpatialTrajectory& estimate,
                               const EvaluateSettings& settings);
/// Aligns `pairs.estimate` in place. Throws host::UserError (refused) when it is not determined.
Alignment align_pairs(PosePairs& pairs, AlignmentKind kind, const std::string& name);

/// Throw host::UserError (refused) when no error can be computed.
[[nodiscard]] EvaluateResult evaluate_ape(PosePairs& pairs, const EvaluateSettings& settings,
                                          const std::string& name);
[[nodiscard]] EvaluateResult evaluate_rpe(PosePairs& pairs, const EvaluateSettings& settings,
                                          const std::string& name);
[[nodiscard]] SegmentReport evaluate_segments(const PosePairs& pairs, const std::string& name);

}  // namespace picolo::tool
