// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One walk over the points: the weighted sums of Gauss-Newton on a likelihood field.
///
/// The order of summation is the contract: point k belongs to lane k mod 8, each lane sums its
/// points in order, the lanes are folded by one fixed tree. A vector target walks 8 points at once,
/// a scalar one lane by lane: the bits are the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/map/bilinear_lanes.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

struct FieldSums {
  float xx = 0.0F, xy = 0.0F, xt = 0.0F, yy = 0.0F, yt = 0.0F, tt = 0.0F;  // sum w J'J
  float bx = 0.0F, by = 0.0F, bt = 0.0F;                                   // sum w J'r
  float robust_squares =
      0.0F;               // sum w r^2: grows to the kernel's width squared a point and no further
  float residual = 0.0F;  // sum r over points inside
  float inside = 0.0F;
  float inliers = 0.0F;
  float squared_radius = 0.0F;  // sum of |p - base|^2 over points inside
};

/// sine and cosine of the pose's yaw, hoisted.
struct FieldWalk {
  float x_m, y_m, sine, cosine;
  float inverse_kernel_squared;  // of the unit-free residual; 0: no kernel
  float inlier_residual;         // unit-free
};

inline float fold(const Lanes& lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
         ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

struct LaneSums {
  Lanes xx{}, xy{}, xt{}, yy{}, yt{}, tt{}, bx{}, by{}, bt{}, robust_squares{}, residual{},
      inside{}, inliers{}, squared_radius{};
};

inline FieldSums fold(const LaneSums& sums) {
  return {fold(sums.xx),       fold(sums.xy),
          fold(sums.xt),       fold(sums.yy),
          fold(sums.yt),       fold(sums.tt),
          fold(sums.bx),       fold(sums.by),
          fold(sums.bt),       fold(sums.robust_squares),
          fold(sums.residual), fold(sums.inside),
          fold(sums.inliers),  fold(sums.squared_radius)};
}

/// Of a unit vector along a surface in steps of 1 / 127.
inline constexpr float kPerSquaredStep = 1.0F / (127.0F * 127.0F);

/// Eight points; without surfaces `along_x` and `along_y` are not read.
struct EightPoints {
  const float* x_m;
  const float* y_m;
  const std::int8_t* along_x;
  const std::int8_t* along_y;
};

template <bool WithSurfaces, typename Field>
inline void add_lanes(const Field& field, const FieldWalk& walk, const EightPoints& points,
                      LaneSums& sums) {
  const float* const x_m = points.x_m;
  const float* const y_m = points.y_m;
  Lanes arm_x, arm_y, at_x_m, at_y_m;
  for (std::size_t l = 0; l < kLanes; ++l) {
    arm_x[l] = walk.cosine * x_m[l] - walk.sine * y_m[l];
    arm_y[l] = walk.sine * x_m[l] + walk.cosine * y_m[l];
    at_x_m[l] = arm_x[l] + walk.x_m;
    at_y_m[l] = arm_y[l] + walk.y_m;
  }
  FieldLanes at;
  sample_lanes(field, at_x_m, at_y_m, at);
  const Lanes& value = at.value;
  const Lanes& inside = at.inside;
  Lanes& slope_x = at.slope_x_per_m;
  Lanes& slope_y = at.slope_y_per_m;
  for (std::size_t l = 0; l < kLanes; ++l) {
    arm_x[l] = inside[l] > 0.0F ? arm_x[l] : 0.0F;  // a NaN outside must not reach the sums
    arm_y[l] = inside[l] > 0.0F ? arm_y[l] : 0.0F;
  }
  if constexpr (WithSurfaces) {
    // Along its own surface a point moves freely: what the field's slope says there is the pattern
    // of single hits, not the wall.
    for (std::size_t l = 0; l < kLanes; ++l) {
      const auto x = static_cast<float>(points.along_x[l]);
      const auto y = static_cast<float>(points.along_y[l]);
      const float along_x = walk.cosine * x - walk.sine * y;
      const float along_y = walk.sine * x + walk.cosine * y;
      const float along = kPerSquaredStep * (slope_x[l] * along_x + slope_y[l] * along_y);
      slope_x[l] -= along * along_x;
      slope_y[l] -= along * along_y;
    }
  }
  for (std::size_t l = 0; l < kLanes; ++l) {
    // dS/dtheta = (-sin x - cos y, cos x - sin y) = (-arm_y, arm_x)
    const float slope_t = slope_y[l] * arm_x[l] - slope_x[l] * arm_y[l];
    const float residual = inside[l] * (1.0F - value[l]);
    const float weight = inside[l] / (1.0F + residual * residual * walk.inverse_kernel_squared);
    const float wx = weight * slope_x[l];
    const float wy = weight * slope_y[l];
    const float wt = weight * slope_t;
    sums.xx[l] += wx * slope_x[l];
    sums.xy[l] += wx * slope_y[l];
    sums.xt[l] += wx * slope_t;
    sums.yy[l] += wy * slope_y[l];
    sums.yt[l] += wy * slope_t;
    sums.tt[l] += wt * slope_t;
    sums.bx[l] += wx * residual;
    sums.by[l] += wy * residual;
    sums.bt[l] += wt * residual;
    sums.robust_squares[l] += weight * residual * residual;
    sums.residual[l] += residual;
    sums.inside[l] += inside[l];
    sums.inliers[l] += residual <= walk.inlier_residual ? inside[l] : 0.0F;
    sums.squared_radius[l] += arm_x[l] * arm_x[l] + arm_y[l] * arm_y[l];
  }
}

template <bool WithSurfaces, typename Field>
inline FieldSums walk_lanes(const Field& field, const FieldWalk& walk, const PointsView& points) {
  LaneSums sums;
  const std::size_t whole = points.size() - points.size() % kLanes;
  for (std::size_t k = 0; k < whole; k += kLanes) {
    add_lanes<WithSurfaces>(field, walk,
                            {points.x_m.data() + k, points.y_m.data() + k,
                             WithSurfaces ? points.along_x.data() + k : nullptr,
                             WithSurfaces ? points.along_y.data() + k : nullptr},
                            sums);
  }
  if (whole < points.size()) {
    Lanes x_m,
        y_m;  // what is missing from the last eight lies outside of every window and adds nothing
    std::array<std::int8_t, kLanes> along_x{}, along_y{};
    x_m.fill(1e9F);
    y_m.fill(1e9F);
    for (std::size_t k = whole; k < points.size(); ++k) {
      x_m[k - whole] = points.x_m[k];
      y_m[k - whole] = points.y_m[k];
      if constexpr (WithSurfaces) {
        along_x[k - whole] = points.along_x[k];
        along_y[k - whole] = points.along_y[k];
      }
    }
    add_lanes<WithSurfaces>(field, walk, {x_m.data(), y_m.data(), along_x.data(), along_y.data()},
                            sums);
  }
  return fold(sums);
}

/// The same sums, one lane after the other: for processors without vectors, whose registers hold
/// the sums of one lane. A point outside adds nothing, so it may be left out.
template <bool WithSurfaces, typename Field>
inline FieldSums walk_points(const Field& field, const FieldWalk& walk, const PointsView& points) {
  LaneSums sums;
  for (std::size_t l = 0; l < kLanes; ++l) {
    FieldSums sum;
    for (std::size_t k = l; k < points.size(); k += kLanes) {
      const float x_m = points.x_m[k];
      const float y_m = points.y_m[k];
      const float arm_x = walk.cosine * x_m - walk.sine * y_m;
      const float arm_y = walk.sine * x_m + walk.cosine * y_m;
      const FieldSample at = sample(field, arm_x + walk.x_m, arm_y + walk.y_m);
      if (!(at.inside > 0.0F)) { continue; }
      float slope_x = at.slope_x_per_m;
      float slope_y = at.slope_y_per_m;
      if constexpr (WithSurfaces) {
        const auto x = static_cast<float>(points.along_x[k]);
        const auto y = static_cast<float>(points.along_y[k]);
        const float along_x = walk.cosine * x - walk.sine * y;
        const float along_y = walk.sine * x + walk.cosine * y;
        const float along = kPerSquaredStep * (slope_x * along_x + slope_y * along_y);
        slope_x -= along * along_x;
        slope_y -= along * along_y;
      }
      const float slope_t = slope_y * arm_x - slope_x * arm_y;
      const float residual = 1.0F - at.value;
      const float weight = 1.0F / (1.0F + residual * residual * walk.inverse_kernel_squared);
      const float wx = weight * slope_x;
      const float wy = weight * slope_y;
      const float wt = weight * slope_t;
      sum.xx += wx * slope_x;
      sum.xy += wx * slope_y;
      sum.xt += wx * slope_t;
      sum.yy += wy * slope_y;
      sum.yt += wy * slope_t;
      sum.tt += wt * slope_t;
      sum.bx += wx * residual;
      sum.by += wy * residual;
      sum.bt += wt * residual;
      sum.robust_squares += weight * residual * residual;
      sum.residual += residual;
      sum.inside += 1.0F;
      sum.inliers += residual <= walk.inlier_residual ? 1.0F : 0.0F;
      sum.squared_radius += arm_x * arm_x + arm_y * arm_y;
    }
    sums.xx[l] = sum.xx;
    sums.xy[l] = sum.xy;
    sums.xt[l] = sum.xt;
    sums.yy[l] = sum.yy;
    sums.yt[l] = sum.yt;
    sums.tt[l] = sum.tt;
    sums.bx[l] = sum.bx;
    sums.by[l] = sum.by;
    sums.bt[l] = sum.bt;
    sums.robust_squares[l] = sum.robust_squares;
    sums.residual[l] = sum.residual;
    sums.inside[l] = sum.inside;
    sums.inliers[l] = sum.inliers;
    sums.squared_radius[l] = sum.squared_radius;
  }
  return fold(sums);
}

/// Has the target no vectors of floats? Cortex-M.
#if defined(__arm__) && !defined(__ARM_NEON)
inline constexpr bool kWalksPointByPoint = true;
#else
inline constexpr bool kWalksPointByPoint = false;
#endif

template <typename Field>
inline FieldSums walk_field(const Field& field, const FieldWalk& walk, const PointsView& points) {
  const bool surfaces =
      points.along_x.size() == points.size() && points.along_y.size() == points.size();
  if constexpr (kWalksPointByPoint) {
    return surfaces ? walk_points<true>(field, walk, points)
                    : walk_points<false>(field, walk, points);
  } else {
    return surfaces ? walk_lanes<true>(field, walk, points)
                    : walk_lanes<false>(field, walk, points);
  }
}

}  // namespace picolo::inline v0
