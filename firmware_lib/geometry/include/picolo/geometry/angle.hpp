// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Angles on the circle.
#pragma once

namespace picolo::inline v0 {

/// The same direction in [-pi, pi]. Cost: O(1). Exact to an ulp of the input's own error for
/// |angle| <= 1e5.
[[nodiscard]] float wrap_angle(float angle_rad);
[[nodiscard]] double wrap_angle(double angle_rad);

}  // namespace picolo::inline v0
