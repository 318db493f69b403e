// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Umeyama 1991, "Least-squares estimation of transformation parameters between two point patterns":
// with the cross-covariance U D V', rotation U S V', S = diag(1, 1, det U det V); scale tr(D S) /
// variance of the source.

#include "picolo/evaluation/alignment.hpp"

#include "picolo/core/number_model.hpp"
#include "picolo/geometry/best_rotation.hpp"

namespace picolo::inline v0 {
namespace {

struct Moments {
  Vector3d reference_mean{};
  Vector3d estimate_mean{};
  Matrix3d cross_covariance{};  ///< of reference (rows) and estimate (columns)
  double estimate_variance{};
};

Vector3d mean_position(std::span<const Transform3d> poses) {
  Vector3d total{};
  for (const Transform3d& pose : poses) { total = sum(total, pose.translation_m); }
  return scaled(total, 1.0 / static_cast<double>(poses.size()));
}

Moments moments_of(std::span<const Transform3d> reference, std::span<const Transform3d> estimate) {
  Moments moments{.reference_mean = mean_position(reference),
                  .estimate_mean = mean_position(estimate)};
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Vector3d r = difference(reference[i].translation_m, moments.reference_mean);
    const Vector3d e = difference(estimate[i].translation_m, moments.estimate_mean);
    moments.cross_covariance = sum(moments.cross_covariance, outer(r, e));
    moments.estimate_variance += dot(e, e);
  }
  const double share = 1.0 / static_cast<double>(reference.size());
  for (double& entry : moments.cross_covariance.elements) { entry *= share; }
  moments.estimate_variance *= share;
  return moments;
}

Alignment around_means(const Moments& moments, const Matrix3d& rotation, double scale) {
  const Vector3d turned = scaled(product(rotation, moments.estimate_mean), scale);
  return {{rotation, difference(moments.reference_mean, turned)}, scale};
}

Result<Alignment> planar(const Moments& moments) {
  const Result<BestPlanarRotation> best = best_planar_rotation(moments.cross_covariance, 0.0);
  if (!best) { return best.status(); }
  const double co = best->cosine;
  const double si = best->sine;
  Alignment result = around_means(moments, {{co, -si, 0.0, si, co, 0.0, 0.0, 0.0, 1.0}}, 1.0);
  result.motion.translation_m.z = 0.0;
  return result;
}

Result<Alignment> spatial(const Moments& moments, bool with_scale) {
  constexpr double kRankTolerance = 3.0 * 2.220446049250313e-16;
  const Result<BestRotation> best = best_rotation(moments.cross_covariance, kRankTolerance);
  if (!best) { return best.status(); }
  const double scale = with_scale ? best->trace / moments.estimate_variance : 1.0;
  return around_means(moments, best->a_R_b, scale);
}

}  // namespace

Result<Alignment> find_alignment(std::span<const Transform3d> reference,
                                 std::span<const Transform3d> estimate, AlignmentKind kind) {
  if (kind == AlignmentKind::none) { return Alignment{}; }
  if (reference.empty() || reference.size() != estimate.size()) { return Status::invalid_argument; }
  if (kind == AlignmentKind::origin) {
    return Alignment{compose(reference.front(), inverse(estimate.front())), 1.0};
  }
  if (reference.size() < (kind == AlignmentKind::se2 ? 2U : 3U)) {
    return Status::invalid_argument;
  }
  const Moments moments = moments_of(reference, estimate);
  return kind == AlignmentKind::se2 ? planar(moments)
                                    : spatial(moments, kind == AlignmentKind::sim3);
}

Transform3d aligned(const Alignment& alignment, const Transform3d& pose) {
  return compose(alignment.motion, {pose.rotation, scaled(pose.translation_m, alignment.scale)});
}

void align(const Alignment& alignment, std::span<Transform3d> poses) {
  for (Transform3d& pose : poses) { pose = aligned(alignment, pose); }
}

}  // namespace picolo::inline v0
