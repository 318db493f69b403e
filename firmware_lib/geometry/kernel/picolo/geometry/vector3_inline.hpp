// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// `Vector3` arithmetic inline, for the library's own per-point kernels.
#pragma once

#include "picolo/geometry/se3.hpp"

namespace picolo::inline v0::inline3 {

inline Vector3f add(const Vector3f& a, const Vector3f& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector3f sub(const Vector3f& a, const Vector3f& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector3f mul(const Vector3f& a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline float dot3(const Vector3f& a, const Vector3f& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline float square(const Vector3f& a) {
  return dot3(a, a);
}
inline Vector3f cross3(const Vector3f& a, const Vector3f& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A pose with its rotation matrix at hand.
struct Mover {
  Matrix3f r;
  Vector3f t;
  explicit Mover(const Pose3f& pose) : r(to_matrix(pose.rotation)), t(pose.translation_m) {}
  [[nodiscard]] Vector3f operator()(const Vector3f& p) const {
    return {((r(0, 0) * p.x + r(0, 1) * p.y) + r(0, 2) * p.z) + t.x,
            ((r(1, 0) * p.x + r(1, 1) * p.y) + r(1, 2) * p.z) + t.y,
            ((r(2, 0) * p.x + r(2, 1) * p.y) + r(2, 2) * p.z) + t.z};
  }
};

}  // namespace picolo::inline v0::inline3
