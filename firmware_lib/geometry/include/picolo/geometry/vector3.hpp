// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A plain vector of space. Units and frame are those that the owner's name states.
#pragma once

namespace picolo::inline v0 {

template <typename T>
struct Vector3 {
  T x{};
  T y{};
  T z{};
  [[nodiscard]] friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

using Vector3f = Vector3<float>;
using Vector3d = Vector3<double>;

/// For `T` float and double. Cost: at most 6 multiplications and one square root. Context: any.
template <typename T>
[[nodiscard]] Vector3<T> sum(const Vector3<T>& a, const Vector3<T>& b);
template <typename T>
[[nodiscard]] Vector3<T> difference(const Vector3<T>& a, const Vector3<T>& b);
template <typename T>
[[nodiscard]] Vector3<T> scaled(const Vector3<T>& a, T factor);
template <typename T>
[[nodiscard]] T dot(const Vector3<T>& a, const Vector3<T>& b);
template <typename T>
[[nodiscard]] Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b);
template <typename T>
[[nodiscard]] T norm(const Vector3<T>& a);

[[nodiscard]] Vector3d to_f64(const Vector3f& a);
[[nodiscard]] Vector3f to_f32(const Vector3d& a);

}  // namespace picolo::inline v0
