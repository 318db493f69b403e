// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// SE(2): poses of the plane, their group operations and their Jacobians (Sola, Deray, Atchuthan
/// 2018, "A micro Lie theory for state estimation in robotics"). `a_T_b` maps b-coordinates to
/// a-coordinates; frames in names must cancel: a_T_c = a_T_b * b_T_c. Every function exists for
/// `float` (relative to the map window, per sweep) and `double` (world poses).
#pragma once

#include "picolo/core/time.hpp"
#include "picolo/geometry/matrix3.hpp"

namespace picolo::inline v0 {

template <typename T>
struct Point2 {
  T x_m{};
  T y_m{};
  [[nodiscard]] friend constexpr bool operator==(const Point2&, const Point2&) = default;
};

/// Position and yaw; theta in [-pi, pi] after every operation of this file.
template <typename T>
struct Pose2 {
  T x_m{};
  T y_m{};
  T theta_rad{};
  [[nodiscard]] friend constexpr bool operator==(const Pose2&, const Pose2&) = default;
};

/// An element of the Lie algebra se(2): a displacement along a constant twist, in the frame of its
/// left end.
template <typename T>
struct Tangent2 {
  T x_m{};
  T y_m{};
  T theta_rad{};
};

/// A velocity in the frame named by its owner (usually base).
struct Twist2 {
  float x_mps{};
  float y_mps{};
  float omega_radps{};
};

using Point2f = Point2<float>;
using Pose2f = Pose2<float>;
using Pose2d = Pose2<double>;

/// a_T_c = a_T_b * b_T_c. Cost: one sin_cos.
template <typename T>
[[nodiscard]] Pose2<T> compose(const Pose2<T>& a_T_b, const Pose2<T>& b_T_c);
[[nodiscard]] Pose2f operator*(const Pose2f& a_T_b, const Pose2f& b_T_c);
[[nodiscard]] Pose2d operator*(const Pose2d& a_T_b, const Pose2d& b_T_c);

template <typename T>
[[nodiscard]] Pose2<T> inverse(const Pose2<T>& a_T_b);

/// a_T_b^-1 * a_T_c = b_T_c: the pose difference T_last^-1 T_now.
template <typename T>
[[nodiscard]] Pose2<T> between(const Pose2<T>& a_T_b, const Pose2<T>& a_T_c);

/// a_T_b * b_p.
template <typename T>
[[nodiscard]] Point2<T> transform(const Pose2<T>& a_T_b, const Point2<T>& b_p);

/// exp: se(2) -> SE(2), series near zero rotation. Finite and accurate for every |theta| <= pi.
template <typename T>
[[nodiscard]] Pose2<T> exp_se2(const Tangent2<T>& tangent);
/// The motion of a constant twist that lasts.
[[nodiscard]] Pose2d exp_se2(const Twist2& twist, Duration time);
/// log: SE(2) -> se(2), the inverse of exp_se2 for |theta| < pi.
template <typename T>
[[nodiscard]] Tangent2<T> log_se2(const Pose2<T>& pose);

/// Ad(T): T exp(tau) = exp(Ad(T) tau) T.
template <typename T>
[[nodiscard]] Matrix3<T> adjoint(const Pose2<T>& pose);
/// Jr: exp(tau + d) = exp(tau) exp(Jr(tau) d) to first order in d.
template <typename T>
[[nodiscard]] Matrix3<T> right_jacobian(const Tangent2<T>& tangent);
template <typename T>
[[nodiscard]] Matrix3<T> left_jacobian(const Tangent2<T>& tangent);

/// Derivatives of a_T_c = a_T_b * b_T_c in plain coordinates (x, y, theta) of each factor.
template <typename T>
[[nodiscard]] Matrix3<T> compose_jacobian_left(const Pose2<T>& a_T_b, const Pose2<T>& b_T_c);
template <typename T>
[[nodiscard]] Matrix3<T> compose_jacobian_right(const Pose2<T>& a_T_b);

/// Translation linear, rotation along the shortest arc; share 0 gives `from`, 1 gives `to`.
template <typename T>
[[nodiscard]] Pose2<T> interpolate(const Pose2<T>& from, const Pose2<T>& to, T share);

[[nodiscard]] Pose2d to_f64(const Pose2f& pose);
[[nodiscard]] Pose2f to_f32(const Pose2d& pose);

}  // namespace picolo::inline v0
