// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/best_rotation.hpp"

#include <array>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/jacobi_svd.hpp"
#include "picolo/geometry/so3.hpp"

namespace picolo::inline v0 {
namespace {

Vector3d column(const std::array<double, 9>& column_major, std::size_t k) {
  return {column_major[3 * k], column_major[3 * k + 1], column_major[3 * k + 2]};
}

}  // namespace

Result<BestRotation> best_rotation(const Matrix3d& correlation, double rank_tolerance) {
  std::array<double, 9> us = transpose(correlation).elements;  // column-major
  std::array<double, 9> v{};
  std::array<double, 3> s{};
  // A matrix that is not finite gives no finite singular value, which the comparison refuses.
  const Status status = jacobi_svd(us, 3, 3, v, s);
  if (!is_ok(status) || !(s[1] > rank_tolerance * s[0])) { return Status::degenerate; }
  const Vector3d u1 = scaled(column(us, 0), 1.0 / s[0]);
  const Vector3d u2 = scaled(column(us, 1), 1.0 / s[1]);
  // Right-handed third axes make a rotation of any signs; the third singular value may be zero.
  const Vector3d u3 = cross(u1, u2);
  const Vector3d v3 = cross(column(v, 0), column(v, 1));
  const Matrix3d plane = sum(outer(u1, column(v, 0)), outer(u2, column(v, 1)));
  const double third = dot(u3, column(us, 2)) * dot(v3, column(v, 2));
  return BestRotation{sum(plane, outer(u3, v3)), (s[0] + s[1]) + third};
}

Result<BestPlanarRotation> best_planar_rotation(const Matrix3d& correlation,
                                                double rank_tolerance) {
  const Matrix3d& c = correlation;
  const double cosine = c(0, 0) + c(1, 1);
  const double sine = c(1, 0) - c(0, 1);
  const double length = hypotenuse(cosine, sine);
  const double scale = hypotenuse(hypotenuse(c(0, 0), c(0, 1)), hypotenuse(c(1, 0), c(1, 1)));
  if (!(length > rank_tolerance * scale)) { return Status::degenerate; }
  return BestPlanarRotation{cosine / length, sine / length};
}

}  // namespace picolo::inline v0
