// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Drives of a known vehicle, as the calibration sees them: wheel rates between scans and the
/// lidar's motion with noise.
#pragma once

#include <cmath>
#include <vector>

#include "picolo/calibration/samples.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::test {

struct Noise {
  double scan_m = 0.001;
  double scan_rad = 0.001;
  double tick_rad = 0.0;  ///< quantum of the encoders; 0: exact
};

/// A piece of a drive: speeds of both wheels for a time.
struct Leg {
  double left_radps;
  double right_radps;
  double seconds;
};

inline DriveParameters truth() {
  return {0.0752, 0.0748, 0.402, {0.205, -0.013, 0.035}};
}

/// Samples of 0.2 s. Wheels really turn with the rates; encoders see whole quanta.
inline std::vector<MotionSample> drive(const DriveParameters& vehicle, const std::vector<Leg>& legs,
                                       const Noise& noise, std::uint64_t seed) {
  Random random{seed};
  std::vector<MotionSample> samples;
  double left = 0.0;
  double right = 0.0;
  const auto seen = [&](double angle) {
    return noise.tick_rad > 0.0 ? std::floor(angle / noise.tick_rad) * noise.tick_rad : angle;
  };
  for (const Leg& leg : legs) {
    for (double t = 0.0; t < leg.seconds - 1e-9; t += 0.2) {
      MotionSample sample{0.2, leg.left_radps, leg.right_radps, {}};
      sample.lidar_motion = lidar_motion(vehicle, sample);
      const double x = random.gaussian();
      const double y = random.gaussian();
      const double theta = random.gaussian();
      sample.lidar_motion.x_m += noise.scan_m * x;
      sample.lidar_motion.y_m += noise.scan_m * y;
      sample.lidar_motion.theta_rad =
          wrap_angle(sample.lidar_motion.theta_rad + noise.scan_rad * theta);
      sample.left_radps = (seen(left + 0.2 * leg.left_radps) - seen(left)) / 0.2;
      sample.right_radps = (seen(right + 0.2 * leg.right_radps) - seen(right)) / 0.2;
      left += 0.2 * leg.left_radps;
      right += 0.2 * leg.right_radps;
      samples.push_back(sample);
    }
  }
  return samples;
}

/// What the routine asks for: straights, turns on the spot both ways, arcs both ways; varied by the
/// seed.
inline std::vector<Leg> sufficient_legs(std::uint64_t seed, double seconds = 6.0) {
  Random random{seed};
  std::vector<Leg> legs;
  for (int round = 0; round < 3; ++round) {
    const double speed = random.uniform(4.0, 7.0);
    const double turn = random.uniform(1.5, 3.0);
    const double arc = random.uniform(0.15, 0.35);
    legs.push_back({speed, speed, seconds});
    legs.push_back({-turn, turn, seconds});
    legs.push_back({speed * (1 - arc), speed * (1 + arc), seconds});
    legs.push_back({turn, -turn, seconds});
    legs.push_back({speed * (1 + arc), speed * (1 - arc), seconds});
  }
  return legs;
}

}  // namespace picolo::test
