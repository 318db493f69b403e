// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A log of a vehicle that drives what a calibration needs, in the room of room_log.hpp: TICKS at
/// 100 Hz and scans at 10 Hz whose stamps are late.
#pragma once

#include <cmath>
#include <vector>

#include "picolo/calibration/wheel_model.hpp"
#include "room_log.hpp"

namespace picolo::test {

inline constexpr double kLogTicksPerTurn = 20'000.0;
inline constexpr double kLogLidarAge_s = 0.05;
inline constexpr DriveParameters kLogDrive{0.0752, 0.0748, 0.402, {0.12, -0.02, 0.05}};

struct LogLeg {
  double left_radps;
  double right_radps;
  double seconds;
};

/// Turns, straights and arcs that come back to where they began.
inline std::vector<LogLeg> sufficient_log_legs() {
  std::vector<LogLeg> legs;
  for (int round = 0; round < 4; ++round) {
    for (const LogLeg& leg : {LogLeg{-2, 2, 4}, LogLeg{4, 4, 4}, LogLeg{-4, -4, 4},
                              LogLeg{2, -2, 4}, LogLeg{2, 4, 4}, LogLeg{-2, -4, 4}, LogLeg{4, 2, 4},
                              LogLeg{-4, -2, 4}, LogLeg{-3, 3, 1}, LogLeg{3, -3, 1}}) {
      legs.push_back(leg);
    }
  }
  return legs;
}

inline std::string calibration_log(const std::vector<LogLeg>& legs) {
  constexpr double kStep_s = 0.01;
  constexpr double kMost = 8.0 * kStep_s;  // change of a wheel's rate
  const RoomWorld world;
  std::string log;
  Pose2d pose{-2.5, 2.0, 0.3};
  std::vector<Pose2d> past{pose};
  double rate[2] = {0.0, 0.0};
  double angle[2] = {0.0, 0.0};
  int step = 0;
  for (const LogLeg& leg : legs) {
    for (double t = 0.0; t < leg.seconds - 1e-9; t += kStep_s) {
      rate[0] += std::clamp(leg.left_radps - rate[0], -kMost, kMost);
      rate[1] += std::clamp(leg.right_radps - rate[1], -kMost, kMost);
      pose = pose * base_motion(kLogDrive, {kStep_s, rate[0], rate[1], {}});
      past.push_back(pose);
      for (int k = 0; k < 2; ++k) { angle[k] += kStep_s * rate[k]; }
      ++step;
      const double stamp = 100.0 + kStep_s * step;
      const double counts = kLogTicksPerTurn / (2.0 * std::numbers::pi);
      log += fmt::format("TICKS {:.3f} {:.0f} {:.0f}\n", stamp, std::floor(angle[0] * counts),
                         std::floor(angle[1] * counts));
      if (step % 10 != 0) { continue; }
      const auto late = static_cast<std::size_t>(step - 5);
      const Pose2d lidar = past[late] * kLogDrive.base_T_lidar;
      log += "FLASER 180";
      for (int beam = 0; beam < 180; ++beam) {
        const double bearing = (-90.0 + beam) * std::numbers::pi / 180.0;
        log += fmt::format(" {:.3f}", world.range_m(lidar, bearing));
      }
      log += fmt::format(" 0 0 0 0 0 0 {:.3f} test {:.3f}\n", stamp, stamp);
    }
  }
  return log;
}

}  // namespace picolo::test
