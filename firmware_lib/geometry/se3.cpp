// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/se3.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

template <typename T>
Pose3<T> compose(const Pose3<T>& a_T_b, const Pose3<T>& b_T_c) {
  return {normalised(compose(a_T_b.rotation, b_T_c.rotation)),
          transform(a_T_b, b_T_c.translation_m)};
}

Pose3f operator*(const Pose3f& a_T_b, const Pose3f& b_T_c) {
  return compose(a_T_b, b_T_c);
}
Pose3d operator*(const Pose3d& a_T_b, const Pose3d& b_T_c) {
  return compose(a_T_b, b_T_c);
}

template <typename T>
Pose3<T> inverse(const Pose3<T>& a_T_b) {
  const Quaternion<T> back = inverse(a_T_b.rotation);
  return {back, scaled(rotate(back, a_T_b.translation_m), T(-1))};
}

template <typename T>
Pose3<T> between(const Pose3<T>& a_T_b, const Pose3<T>& a_T_c) {
  const Quaternion<T> back = inverse(a_T_b.rotation);
  return {normalised(compose(back, a_T_c.rotation)),
          rotate(back, difference(a_T_c.translation_m, a_T_b.translation_m))};
}

template <typename T>
Vector3<T> transform(const Pose3<T>& a_T_b, const Vector3<T>& b_p) {
  return sum(rotate(a_T_b.rotation, b_p), a_T_b.translation_m);
}

template <typename T>
Pose3<T> exp_se3(const Tangent3<T>& tangent) {
  return {exp_so3(tangent.rotation_rad),
          product(left_jacobian_so3(tangent.rotation_rad), tangent.translation_m)};
}

template <typename T>
Tangent3<T> log_se3(const Pose3<T>& pose) {
  const Vector3<T> rotation_rad = log_so3(pose.rotation);
  return {rotation_rad, product(inverse_left_jacobian_so3(rotation_rad), pose.translation_m)};
}

template <typename T>
Tangent3<T> adjoint_times(const Pose3<T>& pose, const Tangent3<T>& tangent) {
  const Vector3<T> rotation_rad = rotate(pose.rotation, tangent.rotation_rad);
  return {rotation_rad, sum(rotate(pose.rotation, tangent.translation_m),
                            cross(pose.translation_m, rotation_rad))};
}

template <typename T>
Pose3<T> perturbed(const Pose3<T>& pose, const Tangent3<T>& step) {
  return {normalised(compose(exp_so3(step.rotation_rad), pose.rotation)),
          sum(pose.translation_m, step.translation_m)};
}

template <typename T>
Pose3<T> interpolate(const Pose3<T>& from, const Pose3<T>& to, T share) {
  const Vector3<T> way = difference(to.translation_m, from.translation_m);
  return {normalised(interpolate(from.rotation, to.rotation, share)),
          sum(from.translation_m, scaled(way, share))};
}

Pose3d to_f64(const Pose3f& pose) {
  return {to_f64(pose.rotation), to_f64(pose.translation_m)};
}
Pose3f to_f32(const Pose3d& pose) {
  return {to_f32(pose.rotation), to_f32(pose.translation_m)};
}

Transform3d compose(const Transform3d& a_T_b, const Transform3d& b_T_c) {
  return {product(a_T_b.rotation, b_T_c.rotation),
          sum(product(a_T_b.rotation, b_T_c.translation_m), a_T_b.translation_m)};
}

Transform3d inverse(const Transform3d& a_T_b) {
  const Matrix3d back = transpose(a_T_b.rotation);
  return {back, scaled(product(back, a_T_b.translation_m), -1.0)};
}

Transform3d between(const Transform3d& a_T_b, const Transform3d& a_T_c) {
  return compose(inverse(a_T_b), a_T_c);
}

Transform3d to_transform(const Pose3d& pose) {
  return {to_matrix(pose.rotation), pose.translation_m};
}
Pose3d to_pose(const Transform3d& transform) {
  return {from_matrix(transform.rotation), transform.translation_m};
}

#define PICOLO_INSTANTIATE(T)                                              \
  template Pose3<T> compose(const Pose3<T>&, const Pose3<T>&);             \
  template Pose3<T> inverse(const Pose3<T>&);                              \
  template Pose3<T> between(const Pose3<T>&, const Pose3<T>&);             \
  template Vector3<T> transform(const Pose3<T>&, const Vector3<T>&);       \
  template Pose3<T> exp_se3(const Tangent3<T>&);                           \
  template Tangent3<T> log_se3(const Pose3<T>&);                           \
  template Tangent3<T> adjoint_times(const Pose3<T>&, const Tangent3<T>&); \
  template Pose3<T> perturbed(const Pose3<T>&, const Tangent3<T>&);        \
  template Pose3<T> interpolate(const Pose3<T>&, const Pose3<T>&, T)
PICOLO_INSTANTIATE(float);
PICOLO_INSTANTIATE(double);
#undef PICOLO_INSTANTIATE

}  // namespace picolo::inline v0
