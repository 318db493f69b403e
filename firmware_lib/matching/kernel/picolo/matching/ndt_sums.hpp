// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Score, gradient and Hessian of the normal distributions transform (Biber and Strasser 2003,
/// section V). The lanes contract of field_sums.hpp holds.
#pragma once

#include <array>
#include <cstddef>

#include "picolo/core/convert_inline.hpp"
#include "picolo/core/math.hpp"
#include "picolo/map/ndt_map.hpp"
#include "picolo/matching/field_sums.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

/// Of f = -score, in (x, y, theta).
struct NdtSums {
  float score = 0.0F;
  std::array<float, 3> gradient{};
  Matrix3f hessian{};       ///< of Newton: indefinite far from a minimum
  Matrix3f information{};   ///< sum of e J' K J with K the stiff part of S^-1: never indefinite
  float points = 0.0F;      ///< that met at least one cell
  float inliers = 0.0F;     ///< of these, within 3 sigma of one of them
  float residual_m = 0.0F;  ///< sum over the points of the least |S^-1 q| / trace(S^-1)
};

struct NdtWalk {
  float x_m, y_m, sine, cosine;
  float sharpness = 1.0F;  ///< of every cell: factor on the inverse covariance, below 1 to widen
};

struct NdtLanes {
  Lanes score{}, gx{}, gy{}, gt{}, hxx{}, hxy{}, hxt{}, hyy{}, hyt{}, htt{}, ixx{}, ixy{}, ixt{},
      iyy{}, iyt{}, itt{}, points{}, inliers{}, residual_m{};
};

inline const NdtCell* ndt_cell_at(const NdtView& view, int grid, float x_m, float y_m,
                                  Point2f& in_cell) {
  const float u = x_m * view.cells_per_m + ((grid & 1) != 0 ? 0.5F : 0.0F);
  const float v = y_m * view.cells_per_m + ((grid >> 1) != 0 ? 0.5F : 0.0F);
  if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(view.width) &&
        v < static_cast<float>(view.height))) {
    return nullptr;
  }
  const std::int32_t column = truncate_bounded(u);
  const std::int32_t row = truncate_bounded(v);
  in_cell = {(u - static_cast<float>(column)) * view.cell_m,
             (v - static_cast<float>(row)) * view.cell_m};
  const NdtCell* const cell =
      view.grids[static_cast<std::size_t>(grid)] +
      (static_cast<std::ptrdiff_t>(row) * view.width + static_cast<std::ptrdiff_t>(column));
  return cell->inverse_xx > 0.0F ? cell : nullptr;
}

inline void add_ndt_point(const NdtView& view, const NdtWalk& walk, float x_m, float y_m,
                          std::size_t l, NdtLanes& sums) {
  constexpr float kNothing = 30.0F;  // exp(-15): below the last bit of a sum of a hundred points
  const float rx = walk.cosine * x_m - walk.sine * y_m;
  const float ry = walk.sine * x_m + walk.cosine * y_m;
  bool met = false;
  bool inlier = false;
  float nearest_m = 0.0F;
  for (int grid = 0; grid < kNdtGrids; ++grid) {
    Point2f at{};
    const NdtCell* const cell = ndt_cell_at(view, grid, rx + walk.x_m, ry + walk.y_m, at);
    if (cell == nullptr) { continue; }
    const float a = walk.sharpness * cell->inverse_xx;
    const float b = walk.sharpness * cell->inverse_xy;
    const float c = walk.sharpness * cell->inverse_yy;
    const float qx = at.x_m - cell->mean_x_m;
    const float qy = at.y_m - cell->mean_y_m;
    const float sx = a * qx + b * qy;  // S^-1 q
    const float sy = b * qx + c * qy;
    const float squared = qx * sx + qy * sy;
    const float away_m = hypotenuse(sx, sy) / (a + c);
    nearest_m = met && nearest_m < away_m ? nearest_m : away_m;
    met = true;
    inlier |= squared <= 9.0F * walk.sharpness;
    if (!(squared < kNothing)) { continue; }
    const float e = exponential(-0.5F * squared);
    const float st = sy * rx - sx * ry;  // q' S^-1 dq/dtheta, dq/dtheta = (-ry, rx)
    const float tx = b * rx - a * ry;    // S^-1 dq/dtheta
    const float ty = c * rx - b * ry;
    const float tt = rx * ty - ry * tx;
    const float curve = -(sx * rx + sy * ry);  // q' S^-1 d2q/dtheta2
    sums.score[l] += e;
    sums.gx[l] += e * sx;
    sums.gy[l] += e * sy;
    sums.gt[l] += e * st;
    sums.hxx[l] += e * (a - sx * sx);
    sums.hxy[l] += e * (b - sx * sy);
    sums.hxt[l] += e * (tx - sx * st);
    sums.hyy[l] += e * (c - sy * sy);
    sums.hyt[l] += e * (ty - sy * st);
    sums.htt[l] += e * ((tt + curve) - st * st);
    const float kxx = walk.sharpness * cell->stiff_xx;
    const float kxy = walk.sharpness * cell->stiff_xy;
    const float kyy = walk.sharpness * cell->stiff_yy;
    const float ux = kxy * rx - kxx * ry;
    const float uy = kyy * rx - kxy * ry;
    sums.ixx[l] += e * kxx;
    sums.ixy[l] += e * kxy;
    sums.ixt[l] += e * ux;
    sums.iyy[l] += e * kyy;
    sums.iyt[l] += e * uy;
    sums.itt[l] += e * (rx * uy - ry * ux);
  }
  sums.points[l] += met ? 1.0F : 0.0F;
  sums.inliers[l] += inlier ? 1.0F : 0.0F;
  sums.residual_m[l] += nearest_m;
}

inline NdtSums walk_ndt(const NdtView& view, const NdtWalk& walk, const PointsView& points) {
  NdtLanes sums;
  for (std::size_t k = 0; k < points.size(); ++k) {
    add_ndt_point(view, walk, points.x_m[k], points.y_m[k], k % kLanes, sums);
  }
  const float hxy = fold(sums.hxy);
  const float hxt = fold(sums.hxt);
  const float hyt = fold(sums.hyt);
  const float ixy = fold(sums.ixy);
  const float ixt = fold(sums.ixt);
  const float iyt = fold(sums.iyt);
  return {fold(sums.score),
          {fold(sums.gx), fold(sums.gy), fold(sums.gt)},
          {{fold(sums.hxx), hxy, hxt, hxy, fold(sums.hyy), hyt, hxt, hyt, fold(sums.htt)}},
          {{fold(sums.ixx), ixy, ixt, ixy, fold(sums.iyy), iyt, ixt, iyt, fold(sums.itt)}},
          fold(sums.points),
          fold(sums.inliers),
          fold(sums.residual_m)};
}

}  // namespace picolo::inline v0
