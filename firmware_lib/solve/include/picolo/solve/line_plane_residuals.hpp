// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Point-to-plane and point-to-line residuals of a pose in space (Zhang, Singh 2014, "LOAM"), under
/// the left perturbation R <- exp(theta) R, t <- t + dt: with p~ = R p + t,
/// dp~ / d(theta, t) = [-(R p)x, I].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "picolo/geometry/se3.hpp"
#include "picolo/solve/robust_kernel.hpp"

namespace picolo::inline v0 {

/// Residual n . (p~ - j), signed.
template <typename T>
struct PlaneResidual {
  Vector3<T> point_m{};  ///< p, in the moving frame
  Vector3<T> plane_m{};  ///< j, a point of the plane, in the fixed frame
  Vector3<T> normal{};   ///< n, unit
};

/// Residual: the way from the line to p~, in two unit directions orthogonal to the line.
template <typename T>
struct LineResidual {
  Vector3<T> point_m{};  ///< p, in the moving frame
  Vector3<T> line_m{};   ///< a, a point of the line, in the fixed frame
  Vector3<T> side{};     ///< unit, orthogonal to the line
  Vector3<T> other{};    ///< unit, orthogonal to the line and to `side`
};

/// A line through `a` along `direction` (any length but zero: then both sides are zero and the
/// residual vanishes).
template <typename T>
[[nodiscard]] LineResidual<T> line_residual(const Vector3<T>& point_m, const Vector3<T>& a_m,
                                            const Vector3<T>& direction);

enum class LineForm : std::uint8_t {
  two_directions,  ///< (side . (p~ - a), other . (p~ - a)): the right Gauss-Newton Hessian
  distance,        ///< its length |nu| / |a - b|: the same minimum, a Hessian of rank one a point
};

/// Distance of p~ from the line through a and b, and its gradient, as MATHEMATICS has it:
/// nu = (p~ - b) x (p~ - a), d = |nu| / |a - b|, gradient nu' [a - b]x / (|nu| |a - b|). On the
/// line, and when a = b, both are zero.
template <typename T>
struct LineDistance {
  T distance_m{};
  Vector3<T> gradient{};
};
template <typename T>
[[nodiscard]] LineDistance<T> line_distance(const Vector3<T>& p_m, const Vector3<T>& a_m,
                                            const Vector3<T>& b_m);

/// H dx = b, H = sum w J'J, b = -sum w J'r, dx = (theta, dt). Index order: rotation x y z,
/// translation x y z.
template <typename T>
struct NormalEquations6 {
  std::array<T, 21> upper{};  ///< H, row by row from the diagonal
  std::array<T, 6> b{};
  T cost{};             ///< sum rho(r^2) / 2
  std::size_t count{};  ///< correspondences
  [[nodiscard]] static constexpr std::size_t index(std::size_t row, std::size_t column) {
    return row * (11 - row) / 2 + column;
  }
};

/// Adds all residuals at `pose`. Correspondence k belongs to lane k mod 8, each lane adds in order,
/// one fixed tree folds the lanes: the same bits on vector and scalar targets.
/// Cost: about 90 flops a plane, 170 a line. Context: any. For `T` float and double.
template <typename T>
void accumulate(std::type_identity_t<std::span<const PlaneResidual<T>>> planes,
                const Pose3<T>& pose, const RobustKernel& kernel, NormalEquations6<T>& system);
template <typename T>
void accumulate(std::type_identity_t<std::span<const LineResidual<T>>> lines, LineForm form,
                const Pose3<T>& pose, const RobustKernel& kernel, NormalEquations6<T>& system);

}  // namespace picolo::inline v0
