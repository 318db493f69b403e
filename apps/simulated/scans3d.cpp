// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/simulated/scans3d.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/math.hpp"

namespace picolo::inline v0 {
namespace {

struct Box {
  Vector3f low_m;
  Vector3f high_m;
};

// The yard itself, seen from inside, then containers in it; z counts from the lidar at the start.
constexpr std::array<Box, 7> kBoxes{{{{-16.0F, -12.0F, -1.6F}, {22.0F, 14.0F, 5.5F}},
                                     {{6.0F, 3.0F, -1.6F}, {9.0F, 5.5F, 1.8F}},
                                     {{10.0F, -8.0F, -1.6F}, {12.5F, -3.0F, 2.2F}},
                                     {{-9.0F, 4.0F, -1.6F}, {-5.5F, 6.5F, 1.2F}},
                                     {{-8.0F, -7.0F, -1.6F}, {-4.0F, -5.0F, 2.6F}},
                                     {{1.0F, 8.0F, -1.6F}, {2.0F, 9.0F, 4.0F}},
                                     {{3.0F, -9.5F, -1.6F}, {4.2F, -8.0F, 3.0F}}}};

constexpr float kNoise_m = 0.01F;
constexpr double kForward_m = 0.18;  // a scan
constexpr double kTurn_rad = 0.035;

/// Where a ray enters and leaves a slab.
void clip(float origin, float direction, float low, float high, float& enter, float& leave) {
  if (direction == 0.0F) {
    if (origin < low || origin > high) { enter = leave + 1.0F; }
    return;
  }
  const float a = (low - origin) / direction;
  const float b = (high - origin) / direction;
  enter = std::max(enter, std::min(a, b));
  leave = std::min(leave, std::max(a, b));
}

float range_along(const Vector3f& origin_m, const Vector3f& direction) {
  float nearest_m = 0.0F;
  for (std::size_t i = 0; i < kBoxes.size(); ++i) {
    float enter = -1e9F;
    float leave = 1e9F;
    clip(origin_m.x, direction.x, kBoxes[i].low_m.x, kBoxes[i].high_m.x, enter, leave);
    clip(origin_m.y, direction.y, kBoxes[i].low_m.y, kBoxes[i].high_m.y, enter, leave);
    clip(origin_m.z, direction.z, kBoxes[i].low_m.z, kBoxes[i].high_m.z, enter, leave);
    if (i == 0) {
      nearest_m = leave;
    } else if (enter <= leave && enter > 0.0F) {
      nearest_m = std::min(nearest_m, enter);
    }
  }
  return nearest_m;
}

}  // namespace

Pose3d Yard::start_T_lidar(double scans) {
  const Vector3d way{kForward_m * scans, 0.0, 0.01 * scans};
  const Vector3d turn{0.002 * scans, -0.001 * scans, kTurn_rad * scans};
  return exp_se3(Tangent3<double>{turn, way});
}

void Yard::measure(std::size_t scan, std::size_t ring,
                   std::array<RingPoint, kYardAzimuths>& points) {
  const float elevation_rad = 0.035F * (static_cast<float>(ring) - 7.5F);
  const SinCos<float> elevation = sin_cos(elevation_rad);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(kYardAzimuths);
    const float azimuth_rad = std::numbers::pi_v<float> * (1.0F - 2.0F * share);
    const SinCos<float> azimuth = sin_cos(azimuth_rad);
    const Pose3f start_T_lidar_now =
        to_f32(start_T_lidar(static_cast<double>(scan) + static_cast<double>(share)));
    const Vector3f direction{elevation.cosine * azimuth.cosine, elevation.cosine * azimuth.sine,
                             elevation.sine};
    const float noise_m = kNoise_m * static_cast<float>(random_.gaussian());
    const float range_m = range_along(start_T_lidar_now.translation_m,
                                      rotate(start_T_lidar_now.rotation, direction)) +
                          noise_m;
    points[i] = {scaled(direction, range_m), 0.1F * share};
  }
}

}  // namespace picolo::inline v0
