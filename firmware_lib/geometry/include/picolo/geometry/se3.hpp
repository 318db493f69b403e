// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// SE(3): poses of space, their group operations, exp and log (Sola, Deray, Atchuthan 2018).
/// `a_T_b` maps b-coordinates to a-coordinates. Every function exists for `float` and `double`
/// where it is a template.
/// Context: any. Cost: O(1).
#pragma once

#include "picolo/geometry/so3.hpp"

namespace picolo::inline v0 {

/// Rotation and translation.
template <typename T>
struct Pose3 {
  Quaternion<T> rotation{};
  Vector3<T> translation_m{};
  [[nodiscard]] friend constexpr bool operator==(const Pose3&, const Pose3&) = default;
};

/// An element of se(3): a displacement along a constant twist.
template <typename T>
struct Tangent3 {
  Vector3<T> rotation_rad{};
  Vector3<T> translation_m{};
};

/// A pose as a file or an evaluation has it: a rotation matrix that may be orthogonal to its
/// printed digits only.
struct Transform3d {
  Matrix3d rotation = Matrix3d::identity();
  Vector3d translation_m{};
  [[nodiscard]] friend constexpr bool operator==(const Transform3d&, const Transform3d&) = default;
};

using Pose3f = Pose3<float>;
using Pose3d = Pose3<double>;

/// a_T_c = a_T_b * b_T_c; the rotation is renormalised.
template <typename T>
[[nodiscard]] Pose3<T> compose(const Pose3<T>& a_T_b, const Pose3<T>& b_T_c);
[[nodiscard]] Pose3f operator*(const Pose3f& a_T_b, const Pose3f& b_T_c);
[[nodiscard]] Pose3d operator*(const Pose3d& a_T_b, const Pose3d& b_T_c);
template <typename T>
[[nodiscard]] Pose3<T> inverse(const Pose3<T>& a_T_b);
/// a_T_b^-1 * a_T_c = b_T_c.
template <typename T>
[[nodiscard]] Pose3<T> between(const Pose3<T>& a_T_b, const Pose3<T>& a_T_c);
/// a_T_b * b_p.
template <typename T>
[[nodiscard]] Vector3<T> transform(const Pose3<T>& a_T_b, const Vector3<T>& b_p);

template <typename T>
[[nodiscard]] Pose3<T> exp_se3(const Tangent3<T>& tangent);
/// Inverse of exp_se3 for rotations below pi.
template <typename T>
[[nodiscard]] Tangent3<T> log_se3(const Pose3<T>& pose);
/// Ad(T) tau: T exp(tau) = exp(Ad(T) tau) T.
template <typename T>
[[nodiscard]] Tangent3<T> adjoint_times(const Pose3<T>& pose, const Tangent3<T>& tangent);

/// The left perturbation of SO(3) x R^3 that the solvers use: R <- exp(theta) R, t <- t + dt,
/// renormalised.
template <typename T>
[[nodiscard]] Pose3<T> perturbed(const Pose3<T>& pose, const Tangent3<T>& step);

/// Translation linear, rotation along the shortest arc; share 0 gives `from`, 1 gives `to`.
template <typename T>
[[nodiscard]] Pose3<T> interpolate(const Pose3<T>& from, const Pose3<T>& to, T share);

[[nodiscard]] Pose3d to_f64(const Pose3f& pose);
[[nodiscard]] Pose3f to_f32(const Pose3d& pose);

/// The matrix form takes the rotation as it stands: no orthogonalisation, the inverse is the
/// transpose.
[[nodiscard]] Transform3d compose(const Transform3d& a_T_b, const Transform3d& b_T_c);
[[nodiscard]] Transform3d inverse(const Transform3d& a_T_b);
[[nodiscard]] Transform3d between(const Transform3d& a_T_b, const Transform3d& a_T_c);
[[nodiscard]] Transform3d to_transform(const Pose3d& pose);
[[nodiscard]] Pose3d to_pose(const Transform3d& transform);

}  // namespace picolo::inline v0
