// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/point_alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cstddef>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;
template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

Vector<2> to_vector(const Point2<double>& p) {
  return {p.x_m, p.y_m};
}
Vector<3> to_vector(const Vector3d& p) {
  return {p.x, p.y, p.z};
}

template <int N>
struct Fit {
  Matrix<N> rotation = Matrix<N>::Identity();
  Vector<N> translation = Vector<N>::Zero();
  bool determined = false;
};

// H = sum q q'^T of the centred points of b and a; H = U S V^T; R = V diag(1, .., det(V U^T)) U^T.
template <int N, typename Point>
Fit<N> fit(std::span<const Point> a_p, std::span<const Point> b_p) {
  const double share = 1.0 / static_cast<double>(a_p.size());
  Vector<N> a_mean = Vector<N>::Zero();
  Vector<N> b_mean = Vector<N>::Zero();
  for (std::size_t i = 0; i < a_p.size(); ++i) {
    a_mean += share * to_vector(a_p[i]);
    b_mean += share * to_vector(b_p[i]);
  }
  Matrix<N> h = Matrix<N>::Zero();
  for (std::size_t i = 0; i < a_p.size(); ++i) {
    const Vector<N> b = to_vector(b_p[i]) - b_mean;
    const Vector<N> a = to_vector(a_p[i]) - a_mean;
    h += b.lazyProduct(a.transpose());
  }
  Fit<N> result;
  if (!h.allFinite()) { return result; }
  const Eigen::JacobiSVD<Matrix<N>> svd{h, Eigen::ComputeFullU | Eigen::ComputeFullV};
  // In the plane one direction gives the rotation, in space two.
  constexpr double kRankTolerance = 1e-12;
  const double scale = h.norm();
  if (!(scale > 0.0) || !(svd.singularValues()(N - 2) > kRankTolerance * scale)) { return result; }
  Vector<N> signs = Vector<N>::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) { signs(N - 1) = -1.0; }
  result.rotation =
      svd.matrixV().lazyProduct(signs.asDiagonal() * svd.matrixU().transpose().eval());
  result.translation = a_mean - result.rotation.lazyProduct(b_mean);
  result.determined = true;
  return result;
}

}  // namespace

Result<Pose2d> align_points(std::span<const Point2<double>> a_p,
                            std::span<const Point2<double>> b_p) {
  if (a_p.size() != b_p.size() || a_p.size() < 2) { return Status::invalid_argument; }
  const Fit<2> found = fit<2>(a_p, b_p);
  if (!found.determined) { return Status::degenerate; }
  return Pose2d{found.translation(0), found.translation(1),
                arc_tangent2(found.rotation(1, 0), found.rotation(0, 0))};
}

Result<Transform3d> align_points(std::span<const Vector3d> a_p, std::span<const Vector3d> b_p) {
  if (a_p.size() != b_p.size() || a_p.size() < 3) { return Status::invalid_argument; }
  const Fit<3> found = fit<3>(a_p, b_p);
  if (!found.determined) { return Status::degenerate; }
  Transform3d a_T_b;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      a_T_b.rotation(row, column) =
          found.rotation(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    }
  }
  a_T_b.translation_m = {found.translation(0), found.translation(1), found.translation(2)};
  return a_T_b;
}

}  // namespace picolo::inline v0
