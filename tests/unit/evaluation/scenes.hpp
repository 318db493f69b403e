// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Trajectories that the tests of evaluation share.
#pragma once

#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/se3.hpp"

namespace picolo::test {

inline Transform3d pose(double x, double y, double z, double rx = 0, double ry = 0, double rz = 0) {
  return to_transform(Pose3d{exp_so3(Vector3d{rx, ry, rz}), {x, y, z}});
}

inline std::vector<Transform3d> wandering(std::size_t count, std::uint64_t seed) {
  Random random{seed};
  std::vector<Transform3d> poses;
  Pose3d now;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(to_transform(now));
    Tangent3<double> step{};
    step.translation_m.x = random.uniform(0.1, 0.5);
    step.translation_m.z = random.uniform(-0.1, 0.1);
    step.rotation_rad.x = random.uniform(-0.1, 0.1);
    step.rotation_rad.z = random.uniform(-0.2, 0.3);
    now = now * exp_se3(step);
  }
  return poses;
}

/// 1 m a step along x, no rotation.
inline std::vector<Transform3d> straight(std::size_t count) {
  std::vector<Transform3d> poses;
  for (std::size_t i = 0; i < count; ++i) { poses.push_back(pose(static_cast<double>(i), 0, 0)); }
  return poses;
}

}  // namespace picolo::test
