// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "floor_kernel.hpp"

#include <cmath>

namespace picolo::bench {

FloorSums floor_sums(const std::uint8_t* cells, int width, float cells_per_m, const Pose2f& pose,
                     const PointsView& points) {
  FloorSums sums{};
  const float c = std::cos(pose.theta_rad);
  const float s = std::sin(pose.theta_rad);
  const float scale = 1.0F / 255.0F;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const float ax = c * points.x_m[k] - s * points.y_m[k];
    const float ay = s * points.x_m[k] + c * points.y_m[k];
    const float u = (ax + pose.x_m) * cells_per_m - 0.5F;
    const float v = (ay + pose.y_m) * cells_per_m - 0.5F;
    const int i = static_cast<int>(u);
    const int j = static_cast<int>(v);
    const float fx = u - static_cast<float>(i);
    const float fy = v - static_cast<float>(j);
    const std::uint8_t* const cell = cells + j * width + i;
    const float s1 = cell[0];
    const float s2 = cell[1];
    const float s4 = cell[width];
    const float s3 = cell[width + 1];
    const float bottom = s1 + fx * (s2 - s1);
    const float top = s4 + fx * (s3 - s4);
    const float residual = scale * (bottom + fy * (top - bottom));
    const float gx = (s2 - s1) + fy * ((s3 - s4) - (s2 - s1));
    const float gy = top - bottom;
    const float gt = gy * ax - gx * ay;
    sums.xx += gx * gx;
    sums.xy += gx * gy;
    sums.xt += gx * gt;
    sums.yy += gy * gy;
    sums.yt += gy * gt;
    sums.tt += gt * gt;
    sums.bx += gx * residual;
    sums.by += gy * residual;
    sums.bt += gt * residual;
  }
  return sums;
}

}  // namespace picolo::bench
