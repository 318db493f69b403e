// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The one bilinear interpolation of the library.
#pragma once

#include <cstddef>

#include "picolo/core/convert_inline.hpp"
#include "picolo/map/likelihood_field.hpp"

namespace picolo::inline v0 {

/// Value and slope between the four cell centres around (x, y), without a branch: lanes of points
/// stay in step.
inline FieldSample sample(const DistanceFieldView& field, float x_m, float y_m) {
  const float u = x_m * field.cells_per_m - 0.5F;
  const float v = y_m * field.cells_per_m - 0.5F;
  const bool inside = (u >= 0.0F) & (v >= 0.0F) & (u < static_cast<float>(field.width - 1)) &
                      (v < static_cast<float>(field.height - 1));
  const float u_in = inside ? u : 0.0F;
  const float v_in = inside ? v : 0.0F;
  const std::int32_t column = truncate_bounded(u_in);
  const std::int32_t row = truncate_bounded(v_in);
  const float fx = u_in - static_cast<float>(column);
  const float fy = v_in - static_cast<float>(row);

  const std::uint8_t* const low = field.cells + (row * field.width + column);
  const std::uint8_t* const high = low + field.width;
  const auto s1 = static_cast<float>(low[0]);   // (x0, y0)
  const auto s2 = static_cast<float>(low[1]);   // (x1, y0)
  const auto s3 = static_cast<float>(high[1]);  // (x1, y1)
  const auto s4 = static_cast<float>(high[0]);  // (x0, y1)

  const float bottom = s1 + fx * (s2 - s1);
  const float top = s4 + fx * (s3 - s4);
  const float distance = bottom + fy * (top - bottom);
  const float along_x = (s2 - s1) + fy * ((s3 - s4) - (s2 - s1));

  constexpr float kPerUnit = 1.0F / 255.0F;
  const float mask = inside ? 1.0F : 0.0F;
  const float slope_scale = mask * (-kPerUnit * field.cells_per_m);
  return {mask * (1.0F - kPerUnit * distance), slope_scale * along_x, slope_scale * (top - bottom),
          mask};
}

}  // namespace picolo::inline v0
