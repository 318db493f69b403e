// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Point-to-plane and point-to-line problems with a known answer.
#pragma once

#include <numbers>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/solve/pose_solver.hpp"

namespace picolo::test {

inline Vector3d random_vector(Random& random, double reach) {
  const double x = random.uniform(-reach, reach);
  const double y = random.uniform(-reach, reach);
  const double z = random.uniform(-reach, reach);
  return {x, y, z};
}

inline Vector3d random_direction(Random& random) {
  for (;;) {
    const Vector3d v = random_vector(random, 1.0);
    const double length = norm(v);
    if (length > 0.1 && length < 1.0) { return scaled(v, 1.0 / length); }
  }
}

/// Rotations at identity, tiny, small, random and near half a turn.
inline std::vector<Pose3d> poses() {
  Random random{41};
  std::vector<Pose3d> all{{}, {exp_so3(Vector3d{1e-9, -1e-9, 1e-9}), {1, 2, 3}}};
  for (const double angle : {1e-6, 1e-3, 0.1, 1.0, 2.5, std::numbers::pi - 1e-6}) {
    for (int i = 0; i < 4; ++i) {
      const Vector3d axis = random_direction(random);
      all.push_back({exp_so3(scaled(axis, angle)), random_vector(random, 5.0)});
    }
  }
  return all;
}

/// Correspondences that `truth` satisfies up to `noise_m`.
struct Scene {
  std::vector<PlaneResidual<double>> planes;
  std::vector<LineResidual<double>> lines;
};

inline Scene scene(const Pose3d& truth, std::size_t planes, std::size_t lines, double noise_m,
                   std::uint64_t seed = 3) {
  Random random{seed};
  Scene result;
  for (std::size_t i = 0; i < planes; ++i) {
    const Vector3d p = random_vector(random, 20.0);
    const Vector3d n = random_direction(random);
    const Vector3d in_plane = cross(n, random_vector(random, 3.0));
    const Vector3d off = scaled(n, noise_m * random.gaussian());
    result.planes.push_back({p, sum(sum(transform(truth, p), in_plane), off), n});
  }
  for (std::size_t i = 0; i < lines; ++i) {
    const Vector3d p = random_vector(random, 20.0);
    const Vector3d d = random_direction(random);
    const Vector3d along = scaled(d, random.uniform(-3, 3));
    const Vector3d off = scaled(random_vector(random, 1.0), noise_m);
    result.lines.push_back(line_residual(p, sum(sum(transform(truth, p), along), off), d));
  }
  return result;
}

template <typename T>
Vector3<T> cast(const Vector3d& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

inline double distance_m(const Pose3d& a, const Pose3d& b) {
  return norm(difference(a.translation_m, b.translation_m));
}
inline double angle_rad(const Pose3d& a, const Pose3d& b) {
  return rotation_angle_rad(compose(inverse(a.rotation), b.rotation));
}

}  // namespace picolo::test
