// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The line and the plane through a handful of points. No iterative eigenvalue solver: for the
/// shapes that are accepted one direction stands out, and a few products find it.
#pragma once

#include <optional>
#include <span>

#include "picolo/core/math.hpp"
#include "picolo/geometry/vector3_inline.hpp"
#include "picolo/odometry/voxel_map.hpp"

namespace picolo::inline v0 {

struct LocalShape {
  Vector3f centre_m{};
  Vector3f direction{};  ///< unit: of the line, or the plane's normal
};

namespace local_shape {

/// Second moments about the mean, divided by the count.
struct Spread {
  Vector3f centre{};
  float xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  [[nodiscard]] float trace() const { return (xx + yy) + zz; }
  [[nodiscard]] Vector3f times(const Vector3f& v) const {
    return {(xx * v.x + xy * v.y) + xz * v.z, (xy * v.x + yy * v.y) + yz * v.z,
            (xz * v.x + yz * v.y) + zz * v.z};
  }
};

inline Spread spread_of(std::span<const Neighbour> points) {
  Spread s;
  const float share = 1.0F / static_cast<float>(points.size());
  for (const Neighbour& n : points) { s.centre = inline3::add(s.centre, n.point_m); }
  s.centre = inline3::mul(s.centre, share);
  for (const Neighbour& n : points) {
    const Vector3f d = inline3::sub(n.point_m, s.centre);
    s.xx += d.x * d.x;
    s.xy += d.x * d.y;
    s.xz += d.x * d.z;
    s.yy += d.y * d.y;
    s.yz += d.y * d.z;
    s.zz += d.z * d.z;
  }
  for (float* entry : {&s.xx, &s.xy, &s.xz, &s.yy, &s.yz, &s.zz}) { *entry *= share; }
  return s;
}

/// The inverse of `s` times its determinant: its largest eigenvector is the smallest one of `s`.
inline Spread adjugate(const Spread& s) {
  Spread a;
  a.xx = s.yy * s.zz - s.yz * s.yz;
  a.xy = s.xz * s.yz - s.xy * s.zz;
  a.xz = s.xy * s.yz - s.xz * s.yy;
  a.yy = s.xx * s.zz - s.xz * s.xz;
  a.yz = s.xy * s.xz - s.xx * s.yz;
  a.zz = s.xx * s.yy - s.xy * s.xy;
  return a;
}

inline std::optional<Vector3f> unit(const Vector3f& v) {
  const float length2 = inline3::square(v);
  if (!(length2 > 1e-30F) || !is_finite(length2)) { return std::nullopt; }
  return inline3::mul(v, 1.0F / square_root(length2));
}

/// Power iteration from the largest column.
inline std::optional<Vector3f> dominant(const Spread& s, int rounds) {
  Vector3f start{s.xx, s.xy, s.xz};
  if (s.yy > s.xx && s.yy >= s.zz) {
    start = {s.xy, s.yy, s.yz};
  } else if (s.zz > s.xx) {
    start = {s.xz, s.yz, s.zz};
  }
  std::optional<Vector3f> v = unit(start);
  for (int i = 0; i < rounds && v; ++i) { v = unit(s.times(*v)); }
  return v;
}

}  // namespace local_shape

/// Nothing when the points lie on a line or off a plane by more than `thickness_m` (each of them).
inline std::optional<LocalShape> plane_through(std::span<const Neighbour> points,
                                               float thickness_m) {
  const auto s = local_shape::spread_of(points);
  const auto a = local_shape::adjugate(s);
  // trace(adj) = l1 l2 + l1 l3 + l2 l3 against trace^2: small when two eigenvalues are.
  constexpr float kLeastBreadth = 0.03F;
  if (!(a.trace() > kLeastBreadth * s.trace() * s.trace())) { return std::nullopt; }
  const auto normal = local_shape::dominant(a, 2);
  if (!normal) { return std::nullopt; }
  for (const Neighbour& n : points) {
    const float off_m = inline3::dot3(*normal, inline3::sub(n.point_m, s.centre));
    if (!(off_m < thickness_m && off_m > -thickness_m)) { return std::nullopt; }
  }
  return LocalShape{s.centre, *normal};
}

/// Nothing unless the spread along the line is `slenderness` times that across it.
inline std::optional<LocalShape> line_through(std::span<const Neighbour> points,
                                              float slenderness) {
  const auto s = local_shape::spread_of(points);
  const auto along = local_shape::dominant(s, 4);
  if (!along) { return std::nullopt; }
  const float length2 = inline3::dot3(*along, s.times(*along));
  if (!(length2 > slenderness * (s.trace() - length2))) { return std::nullopt; }
  return LocalShape{s.centre, *along};
}

}  // namespace picolo::inline v0
