// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is calibrated, with what certainty, and why a calibration is refused.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// The number goes over the wire and into stores: append only.
enum class Parameter : std::uint8_t {
  none = 0,
  wheel_radius_left = 1,   ///< m
  wheel_radius_right = 2,  ///< m
  track_width = 3,         ///< m
  lidar_x = 4,             ///< of base_T_lidar, m
  lidar_y = 5,             ///< of base_T_lidar, m
  lidar_yaw = 6,           ///< of base_T_lidar, rad
  time_offset = 7,         ///< lidar stamp + offset = wheel clock, s
  gyro_bias = 8,           ///< rad/s
  gyro_scale = 9,          ///< true rate over measured rate
  gyro_yaw = 10,           ///< mounting yaw of the IMU in base, rad
  gyro_offset = 11,        ///< gyro stamp + offset = wheel clock, s
  linear_correction = 12,  ///< the 3x3 matrix X of scan = X odom
};

/// Why data cannot determine a parameter. The number goes over the wire: append only.
enum class RefusalReason : std::uint8_t {
  none = 0,
  too_little_data = 1,
  standing_still = 2,
  straight_only = 3,
  pure_rotation = 4,
  constant_arc = 5,  ///< every sample turns at the same ratio of the wheels
  one_turn_direction = 6,
  no_translation = 7,        ///< the lidar's yaw shows only while the vehicle drives
  encoder_disconnected = 8,  ///< one wheel never counts while the lidar sees motion
  encoder_swapped = 9,       ///< left and right exchanged
  encoder_reversed = 10,     ///< a wheel counts backwards
  constant_velocity = 11,    ///< the rotation rate never changes: no feature to align clocks by
  inconsistent = 12,         ///< fresh data contradicts the solution
  aborted = 13,
  numerically_singular = 14,  ///< none of the above, but the solution is not determined
  not_stored = 15,            ///< the storage failed, or a newer version has written there
};

/// none: accepted. Otherwise the reason and the first parameter that cannot be told.
struct Refusal {
  RefusalReason reason = RefusalReason::none;
  Parameter parameter = Parameter::none;
  [[nodiscard]] constexpr explicit operator bool() const { return reason != RefusalReason::none; }
  [[nodiscard]] friend constexpr bool operator==(const Refusal&, const Refusal&) = default;
};

/// A value and its standard deviation, in the unit of its parameter.
struct Estimate {
  double value = 0.0;
  double std = 0.0;
};

[[nodiscard]] const char* to_string(Parameter parameter);
/// One sentence for the person who drives: what the data lacked.
[[nodiscard]] const char* to_string(RefusalReason reason);

}  // namespace picolo::inline v0
