// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/so3.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

/// c0 + x (c1 + x (c2 + ...)).
template <typename T, std::size_t N>
T polynomial(T x, const T (&coefficients)[N]) {
  T sum = coefficients[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) { sum = sum * x + coefficients[i]; }
  return sum;
}

/// Below this angle the closed forms of the Jacobians cancel; the six terms of the series are exact
/// to an ulp there.
template <typename T>
constexpr T kSeriesBelowSquared = T(0.09);

/// I + a [w]x + b [w]x^2.
template <typename T>
Matrix3<T> quadratic_in_skew(const Vector3<T>& w, T a, T b) {
  const T xx = w.x * w.x;
  const T yy = w.y * w.y;
  const T zz = w.z * w.z;
  const T xy = b * (w.x * w.y);
  const T xz = b * (w.x * w.z);
  const T yz = b * (w.y * w.z);
  return {{T(1) - b * (yy + zz), xy - a * w.z, xz + a * w.y, xy + a * w.z, T(1) - b * (xx + zz),
           yz - a * w.x, xz - a * w.y, yz + a * w.x, T(1) - b * (xx + yy)}};
}

/// Quaternion of any length along the rotation of `m`: the four candidates of Shepperd 1978, the
/// best conditioned one.
template <typename T>
Quaternion<T> unscaled_from_matrix(const Matrix3<T>& m) {
  const T trace = (m(0, 0) + m(1, 1)) + m(2, 2);
  if (trace >= m(0, 0) && trace >= m(1, 1) && trace >= m(2, 2)) {
    return {T(1) + trace, m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
  }
  if (m(0, 0) >= m(1, 1) && m(0, 0) >= m(2, 2)) {
    return {m(2, 1) - m(1, 2), T(1) - trace + T(2) * m(0, 0), m(1, 0) + m(0, 1), m(2, 0) + m(0, 2)};
  }
  if (m(1, 1) >= m(2, 2)) {
    return {m(0, 2) - m(2, 0), m(1, 0) + m(0, 1), T(1) - trace + T(2) * m(1, 1), m(2, 1) + m(1, 2)};
  }
  return {m(1, 0) - m(0, 1), m(2, 0) + m(0, 2), m(2, 1) + m(1, 2), T(1) - trace + T(2) * m(2, 2)};
}

}  // namespace

template <typename T>
Quaternion<T> compose(const Quaternion<T>& a, const Quaternion<T>& b) {
  return {((a.w * b.w - a.x * b.x) - a.y * b.y) - a.z * b.z,
          ((a.w * b.x + a.x * b.w) + a.y * b.z) - a.z * b.y,
          ((a.w * b.y - a.x * b.z) + a.y * b.w) + a.z * b.x,
          ((a.w * b.z + a.x * b.y) - a.y * b.x) + a.z * b.w};
}

template <typename T>
Quaternion<T> inverse(const Quaternion<T>& q) {
  return {q.w, -q.x, -q.y, -q.z};
}

template <typename T>
Quaternion<T> normalised(const Quaternion<T>& q) {
  const T length = square_root(((q.w * q.w + q.x * q.x) + q.y * q.y) + q.z * q.z);
  if (!(length > T(0)) || !is_finite(length)) { return {}; }
  const T factor = (q.w < T(0) ? T(-1) : T(1)) / length;
  return {q.w * factor, q.x * factor, q.y * factor, q.z * factor};
}

template <typename T>
Vector3<T> rotate(const Quaternion<T>& q, const Vector3<T>& v) {
  const Vector3<T> axis{q.x, q.y, q.z};
  const Vector3<T> u = scaled(cross(axis, v), T(2));
  return sum(sum(v, scaled(u, q.w)), cross(axis, u));
}

template <typename T>
Matrix3<T> to_matrix(const Quaternion<T>& q) {
  const T norm2 = ((q.w * q.w + q.x * q.x) + q.y * q.y) + q.z * q.z;
  const T s = T(2) / norm2;
  const T xx = s * q.x * q.x;
  const T yy = s * q.y * q.y;
  const T zz = s * q.z * q.z;
  const T xy = s * q.x * q.y;
  const T xz = s * q.x * q.z;
  const T yz = s * q.y * q.z;
  const T wx = s * q.w * q.x;
  const T wy = s * q.w * q.y;
  const T wz = s * q.w * q.z;
  return {{T(1) - yy - zz, xy - wz, xz + wy, xy + wz, T(1) - xx - zz, yz - wx, xz - wy, yz + wx,
           T(1) - xx - yy}};
}

template <typename T>
Quaternion<T> from_matrix(const Matrix3<T>& m) {
  return normalised(unscaled_from_matrix(m));
}

template <typename T>
T rotation_angle_rad(const Quaternion<T>& q) {
  return T(2) * arc_tangent2(norm(Vector3<T>{q.x, q.y, q.z}), q.w < T(0) ? -q.w : q.w);
}

template <typename T>
T rotation_angle_rad(const Matrix3<T>& m) {
  return rotation_angle_rad(unscaled_from_matrix(m));
}

template <typename T>
Quaternion<T> exp_so3(const Vector3<T>& omega_rad) {
  constexpr T kHalfSine[] = {T(0.5), T(-1.0 / 48.0), T(1.0 / 3840.0), T(-1.0 / 645120.0),
                             T(1.0 / 185794560.0)};
  const T t2 = dot(omega_rad, omega_rad);
  const T t = square_root(t2);
  const SinCos<T> half = sin_cos(t / T(2));
  const T factor = t2 < kSeriesBelowSquared<T> ? polynomial(t2, kHalfSine) : half.sine / t;
  return {half.cosine, factor * omega_rad.x, factor * omega_rad.y, factor * omega_rad.z};
}

template <typename T>
Vector3<T> log_so3(const Quaternion<T>& q) {
  constexpr T kSmall = sizeof(T) == 4 ? T(1e-2) : T(1e-4);
  const T sign = q.w < T(0) ? T(-1) : T(1);
  const T w = sign * q.w;
  const Vector3<T> v{q.x, q.y, q.z};
  const T n = norm(v);
  // atan(n / w) / n = (1 - (n / w)^2 / 3 + ...) / w; the squares in n vanish before n itself does.
  const T factor =
      n < kSmall * w ? T(2) / w * (T(1) - (n / w) * (n / w) / T(3)) : T(2) * arc_tangent2(n, w) / n;
  return scaled(v, sign * factor);
}

template <typename T>
Matrix3<T> left_jacobian_so3(const Vector3<T>& w) {
  constexpr T kA[] = {T(0.5),
                      T(-1.0 / 24.0),
                      T(1.0 / 720.0),
                      T(-1.0 / 40320.0),
                      T(1.0 / 3628800.0),
                      T(-1.0 / 479001600.0)};
  constexpr T kB[] = {T(1.0 / 6.0),       T(-1.0 / 120.0),     T(1.0 / 5040.0),
                      T(-1.0 / 362880.0), T(1.0 / 39916800.0), T(-1.0 / 6227020800.0)};
  const T t2 = dot(w, w);
  if (t2 < kSeriesBelowSquared<T>) {
    return quadratic_in_skew(w, polynomial(t2, kA), polynomial(t2, kB));
  }
  const T t = square_root(t2);
  const SinCos<T> sc = sin_cos(t);
  return quadratic_in_skew(w, (T(1) - sc.cosine) / t2, (t - sc.sine) / (t2 * t));
}

template <typename T>
Matrix3<T> inverse_left_jacobian_so3(const Vector3<T>& w) {
  constexpr T kC[] = {T(1.0 / 12.0),      T(1.0 / 720.0),      T(1.0 / 30240.0),
                      T(1.0 / 1209600.0), T(1.0 / 47900160.0), T(691.0 / 1307674368000.0)};
  const T t2 = dot(w, w);
  if (t2 < kSeriesBelowSquared<T>) { return quadratic_in_skew(w, T(-0.5), polynomial(t2, kC)); }
  const T half = square_root(t2) / T(2);
  const SinCos<T> sc = sin_cos(half);
  return quadratic_in_skew(w, T(-0.5), (T(1) - half * sc.cosine / sc.sine) / t2);
}

template <typename T>
Matrix3<T> skew(const Vector3<T>& v) {
  return {{T(0), -v.z, v.y, v.z, T(0), -v.x, -v.y, v.x, T(0)}};
}

template <typename T>
Matrix3<T> outer(const Vector3<T>& a, const Vector3<T>& b) {
  return {{a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y,
           a.z * b.z}};
}

template <typename T>
Vector3<T> product(const Matrix3<T>& m, const Vector3<T>& v) {
  return {(m(0, 0) * v.x + m(0, 1) * v.y) + m(0, 2) * v.z,
          (m(1, 0) * v.x + m(1, 1) * v.y) + m(1, 2) * v.z,
          (m(2, 0) * v.x + m(2, 1) * v.y) + m(2, 2) * v.z};
}

template <typename T>
Quaternion<T> interpolate(const Quaternion<T>& from, const Quaternion<T>& to, T share) {
  const Vector3<T> arc = log_so3(compose(inverse(from), to));
  return compose(from, exp_so3(scaled(arc, share)));
}

Quaterniond to_f64(const Quaternionf& q) {
  return {static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
          static_cast<double>(q.z)};
}

Quaternionf to_f32(const Quaterniond& q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

#define PICOLO_INSTANTIATE(T)                                                 \
  template Quaternion<T> compose(const Quaternion<T>&, const Quaternion<T>&); \
  template Quaternion<T> inverse(const Quaternion<T>&);                       \
  template Quaternion<T> normalised(const Quaternion<T>&);                    \
  template Vector3<T> rotate(const Quaternion<T>&, const Vector3<T>&);        \
  template Matrix3<T> to_matrix(const Quaternion<T>&);                        \
  template Quaternion<T> from_matrix(const Matrix3<T>&);                      \
  template T rotation_angle_rad(const Matrix3<T>&);                           \
  template T rotation_angle_rad(const Quaternion<T>&);                        \
  template Quaternion<T> exp_so3(const Vector3<T>&);                          \
  template Vector3<T> log_so3(const Quaternion<T>&);                          \
  template Matrix3<T> left_jacobian_so3(const Vector3<T>&);                   \
  template Matrix3<T> inverse_left_jacobian_so3(const Vector3<T>&);           \
  template Matrix3<T> skew(const Vector3<T>&);                                \
  template Vector3<T> product(const Matrix3<T>&, const Vector3<T>&);          \
  template Matrix3<T> outer(const Vector3<T>&, const Vector3<T>&);            \
  template Quaternion<T> interpolate(const Quaternion<T>&, const Quaternion<T>&, T)
PICOLO_INSTANTIATE(float);
PICOLO_INSTANTIATE(double);
#undef PICOLO_INSTANTIATE

}  // namespace picolo::inline v0
