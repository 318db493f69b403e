// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From wheel counts to motion: the concept every wheel model satisfies.
#pragma once

#include <array>
#include <concepts>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// Motion of base between two samples of the wheels.
struct WheelIncrement {
  Timestamp from{};
  Timestamp to{};
  Pose2d from_T_to{};     ///< base at `to` in base at `from`
  bool standing = false;  ///< no wheel moved by a single count
};

/// What each encoder counts while its wheel rolls a metre; 0 for one that no wheel rolls on: a
/// steering, or none.
struct EncoderScale {
  std::array<double, kMaxWheels> counts_per_m{};
};

/// `update` returns the motion since the previous sample; `not_ready` for the first sample and
/// after a restart of the counters; `out_of_range` for a sample that is not newer (it is ignored).
template <typename W>
concept WheelOdometry = requires(W& wheels, const WheelTicks& ticks) {
  { wheels.update(ticks) } -> std::same_as<Result<WheelIncrement>>;
  { wheels.encoder_scale() } -> std::same_as<EncoderScale>;
};

/// Derivative of x, y and theta of `from_T_to` with respect to what each encoder turned, metres and
/// radians per radian; row 0 x, 1 y, 2 theta, a column an index of `WheelTicks::ticks`.
struct WheelJacobian {
  std::array<std::array<double, kMaxWheels>, 3> d{};
};

/// `jacobian` belongs to the last increment that `update` returned, and is computed when it is
/// asked for: with the encoders' covariance C, the increment's is J C J'. Cost: two sin_cos in
/// double.
template <typename W>
concept DifferentiableWheelOdometry = WheelOdometry<W> && requires(const W& wheels) {
  { wheels.jacobian() } -> std::same_as<WheelJacobian>;
};

}  // namespace picolo::inline v0
