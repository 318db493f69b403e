// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/pose2.hpp"

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

/// The four coefficients of V and Jr: a = sin t / t, b = (1 - cos t) / t, c = (t - sin t) / t^2, d
/// = (1 - cos t) / t^2.
template <typename T>
struct Coefficients {
  T a, b, c, d;
};

/// Below the threshold the closed forms cancel; the series' first left-out terms are under an ulp
/// there.
template <typename T>
Coefficients<T> coefficients_of(T t) {
  constexpr T kSeriesBelow = sizeof(T) == 4 ? T(0.25) : T(0.03);
  if (magnitude(t) < kSeriesBelow) {
    const T t2 = t * t;
    const T d = T(0.5) - t2 / T(24) * (T(1) - t2 / T(30) * (T(1) - t2 / T(56)));
    const T e = T(1) / T(6) - t2 / T(120) * (T(1) - t2 / T(42) * (T(1) - t2 / T(72)));
    return {T(1) - t2 * e, t * d, t * e, d};
  }
  const SinCos<T> sc = sin_cos(t);
  const T versine = T(1) - sc.cosine;
  return {sc.sine / t, versine / t, (t - sc.sine) / (t * t), versine / (t * t)};
}

}  // namespace

template <typename T>
Pose2<T> compose(const Pose2<T>& a_T_b, const Pose2<T>& b_T_c) {
  const SinCos<T> sc = sin_cos(a_T_b.theta_rad);
  return {a_T_b.x_m + (sc.cosine * b_T_c.x_m - sc.sine * b_T_c.y_m),
          a_T_b.y_m + (sc.sine * b_T_c.x_m + sc.cosine * b_T_c.y_m),
          wrap_angle(a_T_b.theta_rad + b_T_c.theta_rad)};
}

Pose2f operator*(const Pose2f& a_T_b, const Pose2f& b_T_c) {
  return compose(a_T_b, b_T_c);
}
Pose2d operator*(const Pose2d& a_T_b, const Pose2d& b_T_c) {
  return compose(a_T_b, b_T_c);
}

template <typename T>
Pose2<T> inverse(const Pose2<T>& a_T_b) {
  const SinCos<T> sc = sin_cos(a_T_b.theta_rad);
  return {-(sc.cosine * a_T_b.x_m + sc.sine * a_T_b.y_m),
          sc.sine * a_T_b.x_m - sc.cosine * a_T_b.y_m, -a_T_b.theta_rad};
}

template <typename T>
Pose2<T> between(const Pose2<T>& a_T_b, const Pose2<T>& a_T_c) {
  const SinCos<T> sc = sin_cos(a_T_b.theta_rad);
  const T dx = a_T_c.x_m - a_T_b.x_m;
  const T dy = a_T_c.y_m - a_T_b.y_m;
  return {sc.cosine * dx + sc.sine * dy, sc.cosine * dy - sc.sine * dx,
          wrap_angle(a_T_c.theta_rad - a_T_b.theta_rad)};
}

template <typename T>
Point2<T> transform(const Pose2<T>& a_T_b, const Point2<T>& b_p) {
  const SinCos<T> sc = sin_cos(a_T_b.theta_rad);
  return {a_T_b.x_m + (sc.cosine * b_p.x_m - sc.sine * b_p.y_m),
          a_T_b.y_m + (sc.sine * b_p.x_m + sc.cosine * b_p.y_m)};
}

template <typename T>
Pose2<T> exp_se2(const Tangent2<T>& tangent) {
  const Coefficients<T> k = coefficients_of(tangent.theta_rad);
  return {k.a * tangent.x_m - k.b * tangent.y_m, k.b * tangent.x_m + k.a * tangent.y_m,
          wrap_angle(tangent.theta_rad)};
}

template <typename T>
Tangent2<T> log_se2(const Pose2<T>& pose) {
  const Coefficients<T> k = coefficients_of(pose.theta_rad);
  const T determinant = k.a * k.a + k.b * k.b;
  return {(k.a * pose.x_m + k.b * pose.y_m) / determinant,
          (k.a * pose.y_m - k.b * pose.x_m) / determinant, pose.theta_rad};
}

template <typename T>
Matrix3<T> adjoint(const Pose2<T>& pose) {
  const SinCos<T> sc = sin_cos(pose.theta_rad);
  return {{sc.cosine, -sc.sine, pose.y_m, sc.sine, sc.cosine, -pose.x_m, T{0}, T{0}, T{1}}};
}

template <typename T>
Matrix3<T> right_jacobian(const Tangent2<T>& tangent) {
  const Coefficients<T> k = coefficients_of(tangent.theta_rad);
  const T x = tangent.x_m;
  const T y = tangent.y_m;
  return {{k.a, k.b, k.c * x - k.d * y, -k.b, k.a, k.d * x + k.c * y, T{0}, T{0}, T{1}}};
}

template <typename T>
Matrix3<T> left_jacobian(const Tangent2<T>& tangent) {
  return right_jacobian(Tangent2<T>{-tangent.x_m, -tangent.y_m, -tangent.theta_rad});
}

template <typename T>
Matrix3<T> compose_jacobian_left(const Pose2<T>& a_T_b, const Pose2<T>& b_T_c) {
  const SinCos<T> sc = sin_cos(a_T_b.theta_rad);
  Matrix3<T> j = Matrix3<T>::identity();
  j(0, 2) = -sc.sine * b_T_c.x_m - sc.cosine * b_T_c.y_m;
  j(1, 2) = sc.cosine * b_T_c.x_m - sc.sine * b_T_c.y_m;
  return j;
}

template <typename T>
Matrix3<T> compose_jacobian_right(const Pose2<T>& a_T_b) {
  const SinCos<T> sc = sin_cos(a_T_b.theta_rad);
  return {{sc.cosine, -sc.sine, T{0}, sc.sine, sc.cosine, T{0}, T{0}, T{0}, T{1}}};
}

template <typename T>
Pose2<T> interpolate(const Pose2<T>& from, const Pose2<T>& to, T share) {
  if (share == T{1}) { return to; }  // exact, which from + (to - from) is not
  return {from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m),
          wrap_angle(from.theta_rad + share * wrap_angle(to.theta_rad - from.theta_rad))};
}

Pose2d exp_se2(const Twist2& twist, Duration time) {
  const double time_s = to_seconds_f64(time);
  return exp_se2(Tangent2<double>{static_cast<double>(twist.x_mps) * time_s,
                                  static_cast<double>(twist.y_mps) * time_s,
                                  static_cast<double>(twist.omega_radps) * time_s});
}

Pose2d to_f64(const Pose2f& pose) {
  return {static_cast<double>(pose.x_m), static_cast<double>(pose.y_m),
          static_cast<double>(pose.theta_rad)};
}

Pose2f to_f32(const Pose2d& pose) {
  return {static_cast<float>(pose.x_m), static_cast<float>(pose.y_m),
          wrap_angle(static_cast<float>(pose.theta_rad))};
}

#define PICOLO_INSTANTIATE(T)                                                  \
  template Pose2<T> compose(const Pose2<T>&, const Pose2<T>&);                 \
  template Pose2<T> inverse(const Pose2<T>&);                                  \
  template Pose2<T> between(const Pose2<T>&, const Pose2<T>&);                 \
  template Point2<T> transform(const Pose2<T>&, const Point2<T>&);             \
  template Pose2<T> exp_se2(const Tangent2<T>&);                               \
  template Tangent2<T> log_se2(const Pose2<T>&);                               \
  template Matrix3<T> adjoint(const Pose2<T>&);                                \
  template Matrix3<T> right_jacobian(const Tangent2<T>&);                      \
  template Matrix3<T> left_jacobian(const Tangent2<T>&);                       \
  template Matrix3<T> compose_jacobian_left(const Pose2<T>&, const Pose2<T>&); \
  template Matrix3<T> compose_jacobian_right(const Pose2<T>&);                 \
  template Pose2<T> interpolate(const Pose2<T>&, const Pose2<T>&, T)
PICOLO_INSTANTIATE(float);
PICOLO_INSTANTIATE(double);
#undef PICOLO_INSTANTIATE

}  // namespace picolo::inline v0
