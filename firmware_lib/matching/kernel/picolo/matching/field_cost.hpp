// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The robust cost that the sums of `walk_field` are the slope of: half of k^2 log(1 + r^2 / k^2)
/// (Cauchy), half of r^2 without a kernel. Points outside of the window count as r = 1, so that
/// leaving the map is never a gain.
///
/// One logarithm serves 16 points of a lane: the logarithms of a sum of costs are the logarithm of
/// a product. The lanes contract of field_sums.hpp holds.
#pragma once

#include <algorithm>
#include <cstddef>

#include "picolo/core/math.hpp"
#include "picolo/map/bilinear_lanes.hpp"
#include "picolo/matching/field_sums.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

template <typename Field>
inline float cost_of_field(const Field& field, const FieldWalk& walk, const PointsView& points) {
  constexpr std::size_t kBlock = 16 * kLanes;  // (1 + 1 / k^2)^16 fits a float for k >= 0.01
  const bool robust = walk.inverse_kernel_squared > 0.0F;
  Lanes sums{};
  for (std::size_t start = 0; start < points.size(); start += kBlock) {
    const std::size_t end = std::min(points.size(), start + kBlock);
    Lanes products;
    products.fill(1.0F);
    for (std::size_t k = start; k < end; k += kLanes) {
      const std::size_t lanes = std::min(kLanes, end - k);
      Lanes x_m{}, y_m{};
      for (std::size_t l = 0; l < lanes; ++l) {
        const float px_m = points.x_m[k + l];
        const float py_m = points.y_m[k + l];
        x_m[l] = (walk.cosine * px_m - walk.sine * py_m) + walk.x_m;
        y_m[l] = (walk.sine * px_m + walk.cosine * py_m) + walk.y_m;
      }
      FieldLanes at;
      sample_lanes(field, x_m, y_m, at);
      for (std::size_t l = 0; l < lanes; ++l) {
        const float residual = 1.0F - at.value[l];
        const float squared = residual * residual;
        if (robust) {
          products[l] *= 1.0F + squared * walk.inverse_kernel_squared;
        } else {
          sums[l] += squared;
        }
      }
    }
    if (robust) {
      for (std::size_t l = 0; l < kLanes; ++l) { sums[l] += logarithm(products[l]); }
    }
  }
  const float sum = fold(sums);
  return robust ? 0.5F * sum / walk.inverse_kernel_squared : 0.5F * sum;
}

}  // namespace picolo::inline v0
