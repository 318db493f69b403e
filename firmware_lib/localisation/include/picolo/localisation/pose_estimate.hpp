// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the controller publishes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

/// How far the pose may be trusted; docs/architecture.md, "Health".
/// The number goes over the wire: append only.
enum class HealthState : std::uint8_t {
  initialising,
  tracking,
  degraded,  ///< a sensor, a direction or a proof is missing: odometry carries on
  lost,      ///< the pose is not known, and there is nothing to search with
  fault,
  relocalising,  ///< the pose is not known, and is being searched for
};
inline constexpr std::size_t kHealthStates = 6;

/// Why the health state is what it is. The number goes over the wire: append only.
enum class HealthReason : std::uint8_t {
  none = 0,
  starting = 1,                ///< no sweep matched yet
  lidar_silent = 2,            ///< no sweep for longer than configured
  wheels_silent = 3,           ///< no wheel ticks for longer than configured
  gyro_silent = 4,             ///< no IMU sample for longer than configured
  match_rejected = 5,          ///< the last matches did not pass the acceptance test
  direction_unobservable = 6,  ///< the scene does not constrain a direction; odometry carries it
  too_few_points = 7,
  out_of_map = 8,
  relocalising = 9,
  configuration = 10,  ///< a part refuses its configuration
  overrun = 11,        ///< the cycle missed its deadlines
  /// Wheels, gyro and lidar tell different motions, or one of them what cannot be.
  sensors_disagree = 12,
  turn_unverified = 14,  ///< without a gyro: a turn since the last match that nothing confirms
  tilted = 13,           ///< the vehicle leans: the lidar does not see the plane of the map
  ambiguous = 15,        ///< the sweep fits at several places of the map
  unproven = 16,         ///< the pose was doubted, and what is seen from it must first fit again
};

[[nodiscard]] const char* to_string(HealthState state);
[[nodiscard]] const char* to_string(HealthReason reason);

/// The published pose: map_T_base = map_T_odom * odom_T_base(stamp).
struct PoseEstimate {
  Timestamp stamp{};  ///< the instant of the pose
  Pose2d map_T_base{};
  Pose2d odom_T_base{};         ///< continuous
  Twist2 base_twist{};          ///< of base, in base
  Matrix3f match_covariance{};  ///< of map_T_base given the map: x, y in map axes (m^2), theta
                                ///< (rad^2), growing with odometry since
  Matrix3f drift_covariance{};  ///< of the map against the start, same axes; grows with distance
  Pose2f last_jump{};           ///< by how much map_T_odom last moved the published pose, in base
  Duration match_age{};         ///< stamp minus the reference instant of the last accepted match
  std::uint32_t matches = 0;    ///< accepted so far
  HealthState state = HealthState::initialising;
  HealthReason reason = HealthReason::starting;
};

}  // namespace picolo::inline v0
