// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Robust kernels: how much a residual counts that is too large to be noise. The vocabulary of all
/// solvers.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// rho(s) of the squared residual s, width c; the solver's weight is rho'(s).
enum class RobustKind : std::uint8_t {
  none,           ///< s
  huber,          ///< s up to c^2, then 2 c sqrt(s) - c^2: grows linearly, never forgets
  geman_mcclure,  ///< s / (1 + s / c^2): bounded, an outlier's pull vanishes
};

struct RobustKernel {
  RobustKind kind = RobustKind::none;
  float width = 0.1F;  ///< c, in the unit of the residual
  [[nodiscard]] constexpr bool valid() const { return kind == RobustKind::none || width > 0.0F; }
};

/// rho'(s), in (0, 1]. Cost: O(1). Context: any. For `T` float and double.
template <typename T>
[[nodiscard]] T robust_weight(const RobustKernel& kernel, T squared_residual);
/// rho(s).
template <typename T>
[[nodiscard]] T robust_cost(const RobustKernel& kernel, T squared_residual);

}  // namespace picolo::inline v0
