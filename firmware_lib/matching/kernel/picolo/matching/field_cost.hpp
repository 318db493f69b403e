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
#include "picolo/map/bilinear.hpp"
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
    for (std::size_t k = start; k < end; ++k) {
      const float x_m = points.x_m[k];
      const float y_m = points.y_m[k];
      const FieldSample at = sample(field, (walk.cosine * x_m - walk.sine * y_m) + walk.x_m,
                                    (walk.sine * x_m + walk.cosine * y_m) + walk.y_m);
      const float residual = 1.0F - at.value;
      const float squared = residual * residual;
      if (robust) {
        products[k % kLanes] *= 1.0F + squared * walk.inverse_kernel_squared;
      } else {
        sums[k % kLanes] += squared;
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
