// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a controller is told to expect of a recorded log instead of a vehicle.
#pragma once

#include "picolo/controller/controller_config.hpp"

namespace picolo::inline v0 {

/// How far matches of a log are trusted, whose scans may lie a metre of bad odometry apart.
/// `in_given_map`: what contradicts it tells that the pose is wrong, there is nothing new to see.
[[nodiscard]] constexpr MatchTrust trust_of_log(bool in_given_map) {
  MatchTrust trust{.good_inlier_share = 0.0F,
                   .poor_agreement = 0.0F,
                   .min_agreement = 0.0F,
                   .max_correction_m = 100.0F,
                   .max_correction_rad = 4.0F,
                   .max_leap_m = 100.0F,
                   .max_leap_rad = 4.0F,
                   .max_pull_m = 1e6F,
                   .max_pull_rad = 1e6F,
                   .max_wheel_turn_rad = 1e6F,
                   .max_unmatched = 1h};
  if (in_given_map) {
    trust.min_agreement = 0.7F;
    trust.max_leap_m = 1.0F;
    trust.max_leap_rad = 0.6F;
  }
  return trust;
}

/// For a log on the wires of the simulated vehicle (sim::LogPlayer): it has no IMU, its script
/// starts and stops at once, its lidar turns only while it stands, and it drives as long as it
/// takes.
[[nodiscard]] constexpr ControllerConfig on_a_log(ControllerConfig config,
                                                  bool in_given_map = false) {
  config.dead_reckoning.use_gyro = false;
  config.health.expects_gyro = false;
  config.health.max_match_age = 1h;
  config.health.max_lidar_age = 1h;
  config.health.max_blind = 1h;
  config.plausibility.max_wheel_acceleration_mps2 = 1e6F;
  config.trust = trust_of_log(in_given_map);
  return config;
}

}  // namespace picolo::inline v0
