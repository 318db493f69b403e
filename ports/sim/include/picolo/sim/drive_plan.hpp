// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Who steers: along a route, or by a script of twists.
#pragma once

#include <cstddef>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/time.hpp"
#include "picolo/sim/scenes.hpp"
#include "picolo/sim/vehicle.hpp"

namespace picolo::inline v0::sim {

/// One piece of a script, e.g. of a calibration figure.
struct TwistPiece {
  Duration duration{};
  double speed_mps = 0.0;
  double omega_radps = 0.0;
};
using TwistScript = FixedVector<TwistPiece, 64>;

struct DriveLimits {
  Duration stand_at_start = 1s;  ///< for gyro biases and the first map
  double max_speed_mps = 0.6;
  double max_omega_radps = 0.8;
  double max_acceleration_mps2 = 0.5;
  double max_alpha_radps2 = 2.0;
  double look_ahead_m = 0.5;
  [[nodiscard]] constexpr bool valid() const {
    return max_speed_mps > 0.0 && max_omega_radps > 0.0 && max_acceleration_mps2 > 0.0 &&
           max_alpha_radps2 > 0.0 && look_ahead_m > 0.0;
  }
};

/// Chases a point that runs along the route `look_ahead_m` before the vehicle; slows down where it
/// must turn; speed and yaw rate change at bounded rates. Knows the true pose: the drive does not
/// depend on what the controller believes. A script, when not empty, takes the place of the route.
/// At its end the vehicle stands.
class DrivePlan {
 public:
  DrivePlan(const DriveLimits& limits, const Route& route, bool closed, const TwistScript& script);

  /// The command for the step that begins at `state`. Call once a step.
  [[nodiscard]] DriveCommand next(const VehicleState& state);
  /// An open route or a script has come to its end, and the vehicle stands.
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  [[nodiscard]] DriveCommand wanted(const VehicleState& state);
  [[nodiscard]] DriveCommand chase(const VehicleState& state);
  [[nodiscard]] DriveCommand recite(Duration elapsed);
  void advance_target(const Point2d& position);

  DriveLimits limits_;
  Route route_;
  TwistScript script_;
  bool closed_;
  bool finished_ = false;
  std::size_t leg_ = 0;      ///< the target lies between route points leg_ and leg_ + 1
  double leg_done_m_ = 0.0;  ///< how far along that leg
  Point2d target_{};
  DriveCommand last_{};
};

}  // namespace picolo::inline v0::sim
