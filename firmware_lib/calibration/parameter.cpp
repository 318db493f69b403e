// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/parameter.hpp"

namespace picolo::inline v0 {

const char* to_string(Parameter parameter) {
  switch (parameter) {
    case Parameter::none: return "none";
    case Parameter::wheel_radius_left: return "wheel_radius_left";
    case Parameter::wheel_radius_right: return "wheel_radius_right";
    case Parameter::track_width: return "track_width";
    case Parameter::lidar_x: return "lidar_x";
    case Parameter::lidar_y: return "lidar_y";
    case Parameter::lidar_yaw: return "lidar_yaw";
    case Parameter::time_offset: return "time_offset";
    case Parameter::gyro_bias: return "gyro_bias";
    case Parameter::gyro_scale: return "gyro_scale";
    case Parameter::gyro_yaw: return "gyro_yaw";
    case Parameter::gyro_offset: return "gyro_offset";
    case Parameter::linear_correction: return "linear_correction";
  }
  return "unknown";
}

const char* to_string(RefusalReason reason) {
  switch (reason) {
    case RefusalReason::none: return "accepted";
    case RefusalReason::too_little_data: return "too little data";
    case RefusalReason::standing_still: return "the vehicle stands still";
    case RefusalReason::straight_only: return "only straight driving, no turn";
    case RefusalReason::pure_rotation: return "only rotation on the spot, no distance driven";
    case RefusalReason::constant_arc:
      return "one constant arc: both wheels always turn at the same ratio";
    case RefusalReason::one_turn_direction: return "turns in one direction only";
    case RefusalReason::no_translation: return "no translation to see the lidar's yaw by";
    case RefusalReason::encoder_disconnected: return "a wheel encoder does not count";
    case RefusalReason::encoder_swapped: return "the wheel encoders are swapped";
    case RefusalReason::encoder_reversed: return "a wheel encoder counts backwards";
    case RefusalReason::constant_velocity:
      return "constant velocity: nothing to align the clocks by";
    case RefusalReason::inconsistent: return "fresh data contradicts the solution";
    case RefusalReason::aborted: return "aborted";
    case RefusalReason::numerically_singular: return "the data does not determine the solution";
    case RefusalReason::not_stored: return "the storage did not take it";
  }
  return "unknown";
}

}  // namespace picolo::inline v0
