// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A plain 3x3 matrix for public structs: covariances, information, Jacobians of SE(2).
#pragma once

#include <array>
#include <cstddef>

namespace picolo::inline v0 {

/// Row-major; rows and columns ordered (x, y, theta). Units m, m, rad of the frame that the owner
/// states.
template <typename T>
struct Matrix3 {
  std::array<T, 9> elements{};

  [[nodiscard]] constexpr T& operator()(std::size_t row, std::size_t column) {
    return elements[3 * row + column];
  }
  [[nodiscard]] constexpr const T& operator()(std::size_t row, std::size_t column) const {
    return elements[3 * row + column];
  }
  [[nodiscard]] static constexpr Matrix3 diagonal(T xx, T yy, T tt) {
    Matrix3 result;
    result(0, 0) = xx;
    result(1, 1) = yy;
    result(2, 2) = tt;
    return result;
  }
  [[nodiscard]] static constexpr Matrix3 identity() { return diagonal(T{1}, T{1}, T{1}); }
  [[nodiscard]] friend constexpr bool operator==(const Matrix3&, const Matrix3&) = default;
};

using Matrix3f = Matrix3<float>;
using Matrix3d = Matrix3<double>;

/// a * b, a + b, factor * a, transpose: for `T` float and double. Cost: at most 27 multiplications.
template <typename T>
[[nodiscard]] Matrix3<T> product(const Matrix3<T>& a, const Matrix3<T>& b);
template <typename T>
[[nodiscard]] Matrix3<T> sum(const Matrix3<T>& a, const Matrix3<T>& b);
template <typename T>
[[nodiscard]] Matrix3<T> scaled(const Matrix3<T>& a, T factor);
template <typename T>
[[nodiscard]] Matrix3<T> transpose(const Matrix3<T>& a);
/// j * covariance * j^T, symmetrised.
template <typename T>
[[nodiscard]] Matrix3<T> propagate(const Matrix3<T>& j, const Matrix3<T>& covariance);

}  // namespace picolo::inline v0
