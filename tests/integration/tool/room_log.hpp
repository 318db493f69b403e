// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A CARMEN log of a vehicle that drives a circle in a room of 10 x 8 m with two boxes, with wheels
/// that see 3 % too much turn; and the truth.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "picolo/geometry/pose2.hpp"

namespace picolo::test {

struct RoomLog {
  std::string carmen;  ///< FLASER lines
  std::string truth;   ///< TUM
};

struct RoomLogOptions {
  int scans = 120;
  double first_stamp_s = 100.0;
  double period_s = 0.1;  ///< may be zero or negative
  bool odometry = true;   ///< otherwise zeros
  int kidnapped_at = 0;   ///< before this scan the vehicle is carried on; 0: never
  int kidnapped_by = 0;   ///< ... by so many scans of its way, of which the wheels know nothing
};

class RoomWorld {
 public:
  [[nodiscard]] double range_m(const Pose2d& world_T_lidar, double bearing_rad) const {
    const double angle = world_T_lidar.theta_rad + bearing_rad;
    double nearest = 1e9;
    for (const Box& box : kBoxes) { nearest = std::min(nearest, hit(world_T_lidar, angle, box)); }
    return nearest;
  }

 private:
  struct Box {
    double left, low, right, high;
  };
  static constexpr std::array<Box, 3> kBoxes{
      {{-5.0, -4.0, 5.0, 4.0}, {-0.6, -0.8, 0.4, 0.7}, {3.6, 2.2, 4.4, 3.4}}};

  static double hit(const Pose2d& at, double angle, const Box& box) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    double nearest = 1e9;
    const auto offer = [&](double range, double across, double low, double high) {
      if (range > 1e-6 && across >= low && across <= high) { nearest = std::min(nearest, range); }
    };
    for (const double x : {box.left, box.right}) {
      const double range = (x - at.x_m) / c;
      offer(range, at.y_m + range * s, box.low, box.high);
    }
    for (const double y : {box.low, box.high}) {
      const double range = (y - at.y_m) / s;
      offer(range, at.x_m + range * c, box.left, box.right);
    }
    return nearest;
  }
};

inline RoomLog make_room_log(const RoomLogOptions& options = {}) {
  constexpr double kRadius = 2.4;
  constexpr double kStep = 0.03;  // rad of the circle between two scans
  const RoomWorld world;
  RoomLog log;
  Pose2d odometry;
  Pose2d last{kRadius, 0.0, std::numbers::pi / 2};
  for (int i = 0; i < options.scans; ++i) {
    const bool carried = options.kidnapped_at > 0 && i >= options.kidnapped_at;
    const double angle = kStep * (carried ? i + options.kidnapped_by : i);
    const Pose2d truth{kRadius * std::cos(angle), kRadius * std::sin(angle),
                       std::remainder(angle + std::numbers::pi / 2, 2.0 * std::numbers::pi)};
    Pose2d step = i == options.kidnapped_at ? Pose2d{} : between(last, truth);
    step.theta_rad *= 1.03;
    if (options.odometry) { odometry = odometry * step; }
    last = truth;
    const double stamp = options.first_stamp_s + options.period_s * i;
    log.carmen += "FLASER 360";
    for (int beam = 0; beam < 360; ++beam) {
      const double bearing = (-90.0 + 0.5 * beam) * std::numbers::pi / 180.0;
      log.carmen +=
          beam % 40 == 7 ? " 81.91" : fmt::format(" {:.3f}", world.range_m(truth, bearing));
    }
    const std::string pose =
        fmt::format("{:.6f} {:.6f} {:.6f}", odometry.x_m, odometry.y_m, odometry.theta_rad);
    log.carmen += fmt::format(" {} {} {:.6f} test {:.6f}\n", pose, pose, stamp, stamp);
    log.truth +=
        fmt::format("{:.6f} {:.9f} {:.9f} 0 0 0 {:.9f} {:.9f}\n", stamp, truth.x_m, truth.y_m,
                    std::sin(0.5 * truth.theta_rad), std::cos(0.5 * truth.theta_rad));
  }
  return log;
}

}  // namespace picolo::test
