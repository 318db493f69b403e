// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A differential drive that knows its true motion: radii, track and slip are its secret.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/random.hpp"
#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0::sim {

/// True parameters. Controllers are configured with nominal ones: radii 0.1 m, track 0.5 m.
struct VehicleConfig {
  double radius_left_m = 0.0999;
  double radius_right_m = 0.1001;
  double track_m = 0.503;
  /// Each wheel turns too far by this share (one sigma), wandering with the time constant.
  double slip_sigma = 0.01;
  double slip_time_constant_s = 2.0;
  /// Sideways speed in curves: -scrub * speed * yaw rate.
  double scrub_s = 0.005;
  [[nodiscard]] constexpr bool valid() const {
    return radius_left_m > 0.0 && radius_right_m > 0.0 && track_m > 0.0 && slip_sigma >= 0.0 &&
           slip_time_constant_s > 0.0;
  }
};

/// What the vehicle is told to do until the next step.
struct DriveCommand {
  double speed_mps = 0.0;
  double omega_radps = 0.0;
};

struct VehicleState {
  Duration elapsed{};  ///< since the start of the simulation
  Pose2d world_T_base{};
  double speed_mps = 0.0;    ///< forward, in base
  double lateral_mps = 0.0;  ///< to the left, in base
  double omega_radps = 0.0;
  double acceleration_mps2 = 0.0;           ///< rate of change of speed_mps
  double alpha_radps2 = 0.0;                ///< rate of change of omega_radps
  std::array<double, 2> wheel_angle_rad{};  ///< left, right; unbounded, positive rolls forward
  std::array<double, 2> wheel_rate_radps{};
};

/// Integrates in steps of 1 ms and remembers the last 8 s of them.
class Vehicle {
 public:
  Vehicle(const VehicleConfig& config, const Pose2d& world_T_start, std::uint64_t seed);

  /// Moves by kStep along the constant twist of `command`.
  void step(const DriveCommand& command);
  [[nodiscard]] const VehicleState& state() const { return newest_; }
  /// The state at an instant, interpolated between the steps. `out_of_range`: not reached yet, or
  /// forgotten.
  [[nodiscard]] Result<VehicleState> at(Duration elapsed) const;

  static constexpr Duration kStep = 1ms;
  static constexpr std::size_t kRemembered = 8192;

 private:
  VehicleConfig config_;
  Random random_;
  std::array<double, 2> slip_{};
  VehicleState newest_{};
  std::array<VehicleState, kRemembered> history_{};  ///< index: steps modulo kRemembered
};

}  // namespace picolo::inline v0::sim
