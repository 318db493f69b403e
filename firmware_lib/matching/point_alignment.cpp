// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/point_alignment.hpp"

#include <cstddef>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/best_rotation.hpp"
#include "picolo/geometry/so3.hpp"

namespace picolo::inline v0 {
namespace {

constexpr double kRankTolerance = 1e-12;

Vector3d to_space(const Point2<double>& p) {
  return {p.x_m, p.y_m, 0.0};
}
Vector3d to_space(const Vector3d& p) {
  return p;
}

struct Moments {
  Vector3d a_mean{};
  Vector3d b_mean{};
  Matrix3d correlation{};  ///< sum of a b^T of the centred points
};

template <typename Point>
Moments moments_of(std::span<const Point> a_p, std::span<const Point> b_p) {
  const double share = 1.0 / static_cast<double>(a_p.size());
  Moments moments;
  for (std::size_t i = 0; i < a_p.size(); ++i) {
    moments.a_mean = sum(moments.a_mean, scaled(to_space(a_p[i]), share));
    moments.b_mean = sum(moments.b_mean, scaled(to_space(b_p[i]), share));
  }
  for (std::size_t i = 0; i < a_p.size(); ++i) {
    const Vector3d a = difference(to_space(a_p[i]), moments.a_mean);
    const Vector3d b = difference(to_space(b_p[i]), moments.b_mean);
    moments.correlation = sum(moments.correlation, outer(a, b));
  }
  return moments;
}

}  // namespace

Result<Pose2d> align_points(std::span<const Point2<double>> a_p,
                            std::span<const Point2<double>> b_p) {
  if (a_p.size() != b_p.size() || a_p.size() < 2) { return Status::invalid_argument; }
  const Moments moments = moments_of(a_p, b_p);
  const Result<BestPlanarRotation> best = best_planar_rotation(moments.correlation, kRankTolerance);
  if (!best) { return best.status(); }
  const double co = best->cosine;
  const double si = best->sine;
  const Vector3d& b = moments.b_mean;
  return Pose2d{moments.a_mean.x - (co * b.x - si * b.y), moments.a_mean.y - (si * b.x + co * b.y),
                arc_tangent2(si, co)};
}

Result<Transform3d> align_points(std::span<const Vector3d> a_p, std::span<const Vector3d> b_p) {
  if (a_p.size() != b_p.size() || a_p.size() < 3) { return Status::invalid_argument; }
  const Moments moments = moments_of(a_p, b_p);
  const Result<BestRotation> best = best_rotation(moments.correlation, kRankTolerance);
  if (!best) { return best.status(); }
  const Matrix3d& rotation = best->a_R_b;
  return Transform3d{rotation, difference(moments.a_mean, product(rotation, moments.b_mean))};
}

}  // namespace picolo::inline v0
