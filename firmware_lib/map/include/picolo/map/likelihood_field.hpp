// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a matcher needs of a map: a value between 0 and 1 and its slope at any point.
#pragma once

#include <concepts>
#include <cstdint>

#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

/// M(p) and its gradient, the derivative of the same bilinear form (Kohlbrecher et al. 2011, eq.
/// 4-6).
struct FieldSample {
  float value = 0.0F;  ///< in [0, 1]; 1 on an obstacle
  float slope_x_per_m = 0.0F;
  float slope_y_per_m = 0.0F;
  float inside = 0.0F;  ///< 1 inside of the window, 0 outside (value and slopes are then 0)
};

/// One byte a cell: distance to the nearest obstacle, 0 on it, 255 at `reach_m` and beyond; M = 1 -
/// byte / 255, bilinear between cell centres. A view of a map's storage; valid while the map lives,
/// changes as the map changes.
struct DistanceFieldView {
  const std::uint8_t* cells = nullptr;  ///< row-major, row 0 at the window's lower edge
  int width = 0;
  int height = 0;
  float cells_per_m = 20.0F;
  float reach_m = 0.5F;
};

/// Out of line for users of the library; kernels inline it. Cost: about 30 instructions.
[[nodiscard]] FieldSample sample_field(const DistanceFieldView& field, float x_m, float y_m);

/// A field over window coordinates. `reach_m` is the length over which the value falls from 1 to 0:
/// it turns the unit-free residual 1 - M into metres. Kernels call an inline `sample` of the same
/// meaning (map/kernel).
template <typename F>
concept LikelihoodField = requires(const F& field, float x_m, float y_m) {
  { sample_field(field, x_m, y_m) } -> std::same_as<FieldSample>;
  { field.reach_m } -> std::convertible_to<float>;
};

static_assert(LikelihoodField<DistanceFieldView>);

}  // namespace picolo::inline v0
