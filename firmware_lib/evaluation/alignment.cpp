// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Umeyama 1991, "Least-squares estimation of transformation parameters between two point patterns":
// with the cross-covariance U D V', rotation U S V', S = diag(1, 1, det U det V); scale tr(D S) /
// variance of the source.

#include "picolo/evaluation/alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

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

void add_outer(Matrix3d& m, const Vector3d& r, const Vector3d& e) {
  const Matrix3d outer{{r.x * e.x, r.x * e.y, r.x * e.z, r.y * e.x, r.y * e.y, r.y * e.z, r.z * e.x,
                        r.z * e.y, r.z * e.z}};
  m = sum(m, outer);
}

Moments moments_of(std::span<const Transform3d> reference, std::span<const Transform3d> estimate) {
  Moments moments{.reference_mean = mean_position(reference),
                  .estimate_mean = mean_position(estimate)};
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Vector3d r = difference(reference[i].translation_m, moments.reference_mean);
    const Vector3d e = difference(estimate[i].translation_m, moments.estimate_mean);
    add_outer(moments.cross_covariance, r, e);
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
  const Matrix3d& c = moments.cross_covariance;
  const double cosine = c(0, 0) + c(1, 1);
  const double sine = c(1, 0) - c(0, 1);
  const double length = hypotenuse(cosine, sine);
  if (!(length > 0.0)) { return Status::degenerate; }
  const double co = cosine / length;
  const double si = sine / length;
  Alignment result = around_means(moments, {{co, -si, 0.0, si, co, 0.0, 0.0, 0.0, 1.0}}, 1.0);
  result.motion.translation_m.z = 0.0;
  return result;
}

Result<Alignment> spatial(const Moments& moments, bool with_scale) {
  using Matrix = Eigen::Matrix<double, 3, 3>;
  Matrix c;
  for (int i = 0; i < 9; ++i) {
    c(i / 3, i % 3) = moments.cross_covariance.elements[static_cast<std::size_t>(i)];
  }
  const Eigen::JacobiSVD<Matrix> svd{c, Eigen::ComputeFullU | Eigen::ComputeFullV};
  const auto& d = svd.singularValues();
  constexpr double kRankTolerance = 3.0 * 2.220446049250313e-16;
  if (!(d(1) > kRankTolerance * d(0))) { return Status::degenerate; }
  const Matrix& u = svd.matrixU();
  const Matrix& v = svd.matrixV();
  const double reflection = u.determinant() * v.determinant() < 0.0 ? -1.0 : 1.0;
  Matrix3d rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation(static_cast<std::size_t>(row), static_cast<std::size_t>(column)) =
          (u(row, 0) * v(column, 0) + u(row, 1) * v(column, 1)) +
          reflection * u(row, 2) * v(column, 2);
    }
  }
  const double scale =
      with_scale ? ((d(0) + d(1)) + reflection * d(2)) / moments.estimate_variance : 1.0;
  return around_means(moments, rotation, scale);
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
