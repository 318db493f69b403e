// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Saturation of a sensor that does not report it itself.
#pragma once

#include <algorithm>
#include <array>

namespace picolo::inline v0 {

/// Whether one axis at least has reached the end of its range, +-`full_scale` in the axes' unit.
[[nodiscard]] constexpr bool beyond(const std::array<float, 3>& axes, float full_scale) {
  return std::any_of(axes.begin(), axes.end(), [full_scale](float value) {
    return value >= full_scale || value <= -full_scale;
  });
}

}  // namespace picolo::inline v0
