// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// SO(3): rotations of space as unit quaternions and as matrices, their group operations and
/// Jacobians (Sola, Deray, Atchuthan 2018). `a_R_b` maps b-coordinates to a-coordinates. Every
/// function exists for `float` and `double`. Context: any. Cost: O(1), at most two elementary
/// functions.
#pragma once

#include "picolo/geometry/matrix3.hpp"
#include "picolo/geometry/vector3.hpp"

namespace picolo::inline v0 {

/// A unit quaternion (Hamilton); q and -q are the same rotation. Products lose a unit norm slowly:
/// whoever composes in a loop calls `normalised`, or a prediction that is fed back diverges.
template <typename T>
struct Quaternion {
  T w{1};
  T x{};
  T y{};
  T z{};
  [[nodiscard]] friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

using Quaternionf = Quaternion<float>;
using Quaterniond = Quaternion<double>;

/// a_R_c = a_R_b * b_R_c, not normalised.
template <typename T>
[[nodiscard]] Quaternion<T> compose(const Quaternion<T>& a_R_b, const Quaternion<T>& b_R_c);
template <typename T>
[[nodiscard]] Quaternion<T> inverse(const Quaternion<T>& a_R_b);
/// Unit norm, w >= 0. A zero or non-finite quaternion gives the identity.
template <typename T>
[[nodiscard]] Quaternion<T> normalised(const Quaternion<T>& q);
/// a_R_b * b_v.
template <typename T>
[[nodiscard]] Vector3<T> rotate(const Quaternion<T>& a_R_b, const Vector3<T>& b_v);

template <typename T>
[[nodiscard]] Matrix3<T> to_matrix(const Quaternion<T>& q);
/// From a matrix that is a rotation up to rounding; accurate at every angle, half a turn included.
/// Unit norm, w >= 0.
template <typename T>
[[nodiscard]] Quaternion<T> from_matrix(const Matrix3<T>& m);
/// Angle in [0, pi] of a matrix that is a rotation up to rounding. Keeps relative accuracy near
/// zero, where the arc cosine of the trace has none.
template <typename T>
[[nodiscard]] T rotation_angle_rad(const Matrix3<T>& m);
template <typename T>
[[nodiscard]] T rotation_angle_rad(const Quaternion<T>& q);

/// exp: rotation vector (axis times angle in rad) -> rotation, series near zero.
template <typename T>
[[nodiscard]] Quaternion<T> exp_so3(const Vector3<T>& omega_rad);
/// log: the rotation vector of length <= pi; inverse of exp_so3 below pi.
template <typename T>
[[nodiscard]] Vector3<T> log_so3(const Quaternion<T>& q);

/// Jl: exp(w + d) = exp(Jl(w) d) exp(w) to first order in d; Jr(w) = Jl(-w).
template <typename T>
[[nodiscard]] Matrix3<T> left_jacobian_so3(const Vector3<T>& omega_rad);
/// Jl^-1, finite up to and including pi.
template <typename T>
[[nodiscard]] Matrix3<T> inverse_left_jacobian_so3(const Vector3<T>& omega_rad);

/// [v]x: the matrix of u -> v x u.
template <typename T>
[[nodiscard]] Matrix3<T> skew(const Vector3<T>& v);
template <typename T>
[[nodiscard]] Vector3<T> product(const Matrix3<T>& m, const Vector3<T>& v);

/// a b^T.
template <typename T>
[[nodiscard]] Matrix3<T> outer(const Vector3<T>& a, const Vector3<T>& b);
/// Shortest arc with constant rate (slerp); share 0 gives `from`, 1 gives `to`.
template <typename T>
[[nodiscard]] Quaternion<T> interpolate(const Quaternion<T>& from, const Quaternion<T>& to,
                                        T share);

[[nodiscard]] Quaterniond to_f64(const Quaternionf& q);
[[nodiscard]] Quaternionf to_f32(const Quaterniond& q);

}  // namespace picolo::inline v0
