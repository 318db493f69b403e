// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A room with pillars and a 16-ring lidar in it, cast ray by ray; only with functions that give
/// the same bits everywhere.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "picolo/core/math.hpp"
#include "picolo/core/random.hpp"
#include "picolo/geometry/se3.hpp"
#include "picolo/odometry/loam_odometry.hpp"

namespace picolo::test {

struct Box {
  Vector3d low_m;
  Vector3d high_m;
};

/// Distance along the ray to the outside of a box, or to its inside when the ray starts there.
inline double cast(const Box& box, const Vector3d& from, const Vector3d& ray) {
  const double o[] = {from.x, from.y, from.z};
  const double d[] = {ray.x, ray.y, ray.z};
  const double low[] = {box.low_m.x, box.low_m.y, box.low_m.z};
  const double high[] = {box.high_m.x, box.high_m.y, box.high_m.z};
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (std::abs(d[i]) < 1e-12) {
      if (o[i] < low[i] || o[i] > high[i]) { return std::numeric_limits<double>::infinity(); }
      continue;
    }
    const double a = (low[i] - o[i]) / d[i];
    const double b = (high[i] - o[i]) / d[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave || leave <= 0) { return std::numeric_limits<double>::infinity(); }
  return enter > 0 ? enter : leave;
}

struct Room {
  std::vector<Box> boxes{{{-15, -10, -1.5}, {25, 12, 5}}, {{2, 3, -1.5}, {3, 4, 3}},
                         {{6, -5, -1.5}, {6.8, -4, 4}},   {{-6, 5, -1.5}, {-4, 6.5, 2.5}},
                         {{10, 4, -1.5}, {12, 5, 4}},     {{-5, -7, -1.5}, {-3.5, -6, 3}}};

  [[nodiscard]] double range_m(const Vector3d& from, const Vector3d& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Box& box : boxes) { nearest = std::min(nearest, cast(box, from, ray)); }
    return nearest;
  }
};

constexpr std::size_t kRings = 16;
constexpr double kPeriod = 0.1;
using Scan = std::vector<std::vector<RingPoint>>;

/// One revolution from `begin` to `end`, the pose moving evenly in between; with begin == end the
/// points are those of a lidar at rest.
inline Scan scan_of(const Room& room, const Pose3d& begin, const Pose3d& end, double noise_m,
                    std::uint64_t seed, std::size_t steps = 900) {
  Random random{seed};
  Scan scan(kRings);
  for (std::size_t s = 0; s < steps; ++s) {
    const double share = static_cast<double>(s) / static_cast<double>(steps);
    const Pose3d pose = interpolate(begin, end, share);
    const double azimuth = 2 * std::numbers::pi * share;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const double elevation = (15.0 - 2.0 * static_cast<double>(ring)) * std::numbers::pi / 180;
      const SinCos<double> up = sin_cos(elevation);
      const SinCos<double> around = sin_cos(azimuth);
      const Vector3d ray{up.cosine * around.cosine, up.cosine * around.sine, up.sine};
      const double range = room.range_m(pose.translation_m, rotate(pose.rotation, ray)) +
                           noise_m * random.gaussian();
      scan[ring].push_back({to_f32(scaled(ray, range)), static_cast<float>(share * kPeriod)});
    }
  }
  return scan;
}

inline Pose3d on_curve(int i) {
  const double s = 0.25 * i;
  const SinCos<double> wave = sin_cos(s);
  return {exp_so3(Vector3d{0.01 * wave.sine, 0.01 * wave.cosine, 0.04 * i}),
          {s - 3, 1.5 * sin_cos(0.3 * s).sine, 0.05 * wave.sine}};
}

inline int run_scan(LoamCore& core, const Scan& scan) {
  core.begin_scan();
  for (std::size_t ring = 0; ring < scan.size(); ++ring) { (void)core.add_ring(ring, scan[ring]); }
  int slices = 1;
  while (!core.step()) { ++slices; }
  return slices;
}

}  // namespace picolo::test
