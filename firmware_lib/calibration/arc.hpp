// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The chord of an arc of unit length that turns by theta.
#pragma once

namespace picolo::inline v0 {

struct Arc {
  double along;    ///< sin t / t
  double across;   ///< (1 - cos t) / t
  double d_along;  ///< derivatives by t
  double d_across;
  double dd_along;  ///< second derivatives
  double dd_across;
};

/// Series below |theta| = 0.03, where the closed forms cancel.
[[nodiscard]] Arc arc_of(double theta_rad);

}  // namespace picolo::inline v0
