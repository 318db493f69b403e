// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One problem for all solvers: half lines, half planes, 1 cm of noise.
#pragma once

#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/solve/pose_solver.hpp"

namespace picolo::bench {

struct Problem {
  std::vector<PlaneResidual<double>> planes;
  std::vector<LineResidual<double>> lines;
  std::vector<Vector3d> directions;  ///< of the lines, unit
  std::vector<PlaneResidual<float>> planes_f32;
  std::vector<LineResidual<float>> lines_f32;
};

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

inline Problem problem_of(std::size_t residuals) {
  Random random{2024};
  const Pose3d truth{exp_so3(Vector3d{0.02, -0.03, 0.08}), {0.4, -0.2, 0.05}};
  Problem problem;
  for (std::size_t i = 0; i < residuals; ++i) {
    const Vector3d p = random_vector(random, 20.0);
    const Vector3d d = random_direction(random);
    const Vector3d noise = scaled(random_vector(random, 1.0), 0.01);
    const Vector3d at = sum(transform(truth, p), noise);
    if (i % 2 == 0) {
      problem.planes.push_back({p, at, d});
    } else {
      problem.lines.push_back(line_residual(p, at, d));
      problem.directions.push_back(d);
    }
  }
  for (const auto& x : problem.planes) {
    problem.planes_f32.push_back({to_f32(x.point_m), to_f32(x.plane_m), to_f32(x.normal)});
  }
  for (const auto& x : problem.lines) {
    problem.lines_f32.push_back(
        {to_f32(x.point_m), to_f32(x.line_m), to_f32(x.side), to_f32(x.other)});
  }
  return problem;
}

}  // namespace picolo::bench
