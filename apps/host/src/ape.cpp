// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/ape.hpp"

#include <algorithm>
#include <vector>

#include "picolo/core/math.hpp"
#include "picolo/evaluation/alignment.hpp"
#include "picolo/evaluation/association.hpp"
#include "picolo/evaluation/pose_error.hpp"

namespace picolo::host {
namespace {

struct Stamped {
  std::vector<double> stamps_s;
  std::vector<Transform3d> poses;
};

Stamped sorted(std::span<const TrajectoryPose> poses) {
  Trajectory ordered{poses.begin(), poses.end()};
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.stamp_s < b.stamp_s; });
  Stamped result;
  for (const auto& [stamp_s, pose] : ordered) {
    const SinCos<double> yaw = sin_cos(pose.theta_rad);
    Transform3d transform;
    transform.rotation = {{yaw.cosine, -yaw.sine, 0.0, yaw.sine, yaw.cosine, 0.0, 0.0, 0.0, 1.0}};
    transform.translation_m = {pose.x_m, pose.y_m, 0.0};
    result.stamps_s.push_back(stamp_s);
    result.poses.push_back(transform);
  }
  return result;
}

Pose2d in_the_plane(const Transform3d& transform) {
  return {transform.translation_m.x, transform.translation_m.y,
          arc_tangent2(transform.rotation(1, 0), transform.rotation(0, 0))};
}

}  // namespace

ApeSummary evaluate_ape(std::span<const TrajectoryPose> reference,
                        std::span<const TrajectoryPose> estimate, double tolerance_s) {
  const Stamped all_reference = sorted(reference);
  const Stamped all_estimate = sorted(estimate);
  std::vector<IndexPair> pairs(std::min(reference.size(), estimate.size()));
  const auto found =
      associate(all_reference.stamps_s, all_estimate.stamps_s, tolerance_s, 0.0, pairs);
  pairs.resize(found.value_or(0));
  std::vector<Transform3d> truth;
  std::vector<Transform3d> poses;
  for (const IndexPair& pair : pairs) {
    truth.push_back(all_reference.poses[pair.first]);
    poses.push_back(all_estimate.poses[pair.second]);
  }
  ApeSummary ape;
  auto alignment = find_alignment(truth, poses, AlignmentKind::se2);
  if (!alignment) { alignment = find_alignment(truth, poses, AlignmentKind::origin); }
  if (!alignment) { return ape; }
  align(*alignment, poses);
  std::vector<double> errors_m(poses.size());
  if (!is_ok(absolute_errors(truth, poses, PoseRelation::translation, errors_m))) { return ape; }
  ape.statistics = statistics_of(errors_m).value_or({});
  ape.reference_T_estimate = in_the_plane(alignment->motion);
  return ape;
}

Json to_json(const ApeSummary& ape) {
  const ErrorStatistics& of = ape.statistics;
  const auto figure = [&of](double value) { return of.count > 0 ? Json(value) : Json(nullptr); };
  return {{"rmse", figure(of.rmse)},
          {"mean", figure(of.mean)},
          {"median", figure(of.median)},
          {"max", figure(of.max)},
          {"pairs", of.count}};
}

Trajectory transformed(const Pose2d& frame_T_poses, std::span<const TrajectoryPose> poses) {
  Trajectory result;
  result.reserve(poses.size());
  for (const auto& [stamp_s, pose] : poses) { result.push_back({stamp_s, frame_T_poses * pose}); }
  return result;
}

}  // namespace picolo::host
