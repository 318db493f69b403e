// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/vector3.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

template <typename T>
Vector3<T> sum(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename T>
Vector3<T> difference(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename T>
Vector3<T> scaled(const Vector3<T>& a, T factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}

template <typename T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <typename T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
T norm(const Vector3<T>& a) {
  return square_root(dot(a, a));
}

Vector3d to_f64(const Vector3f& a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

Vector3f to_f32(const Vector3d& a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

#define PICOLO_INSTANTIATE(T)                                           \
  template Vector3<T> sum(const Vector3<T>&, const Vector3<T>&);        \
  template Vector3<T> difference(const Vector3<T>&, const Vector3<T>&); \
  template Vector3<T> scaled(const Vector3<T>&, T);                     \
  template T dot(const Vector3<T>&, const Vector3<T>&);                 \
  template Vector3<T> cross(const Vector3<T>&, const Vector3<T>&);      \
  template T norm(const Vector3<T>&)
PICOLO_INSTANTIATE(float);
PICOLO_INSTANTIATE(double);
#undef PICOLO_INSTANTIATE

}  // namespace picolo::inline v0
