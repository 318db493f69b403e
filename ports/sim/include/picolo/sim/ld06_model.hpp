// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// An LD06 lidar that spins while the vehicle moves.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/core/random.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sim/ld06_wire.hpp"
#include "picolo/sim/links.hpp"
#include "picolo/sim/vehicle.hpp"
#include "picolo/sim/world.hpp"

namespace picolo::inline v0::sim {

struct Ld06ModelConfig {
  Pose2d base_T_lidar{.x_m = 0.12, .y_m = 0.0, .theta_rad = 0.0};  ///< true mounting
  double rotation_hz = 10.0;
  int points_per_second = 4500;
  double range_sigma_m = 0.01;
  double min_range_m = 0.02;
  double max_range_m = 12.0;
  double dropout = 0.005;  ///< share of beams that come back empty
  /// Against what an LD06 does: every beam looks to the other side of the x axis than its packet
  /// says. For those who repeat what it says in the words of a lidar that turns so.
  bool counter_clockwise = false;
  Duration latency{};      ///< from the last point of a packet to the packet's first bit
  Duration device_clock_offset = 17s;  ///< the device's own clock at the start of the simulation
  [[nodiscard]] constexpr bool valid() const {
    return rotation_hz > 0.0 && points_per_second > 0 && max_range_m > min_range_m &&
           min_range_m > 0.0 && max_range_m < 65.5 && range_sigma_m >= 0.0 && dropout >= 0.0 &&
           dropout <= 1.0 && latency >= Duration{0};
  }
};

/// Every beam is cast from the true pose at its own time. A packet leaves after its last point was
/// measured, so its first byte begins on the wire `latency` after that point.
class Ld06Model {
 public:
  Ld06Model(const Ld06ModelConfig& config, Timestamp start, std::uint64_t seed);

  /// Measures and sends everything due up to `until`. Precondition: the vehicle has reached
  /// `until`.
  void advance_to(Duration until, const World& world, const Vehicle& vehicle, SerialLink& link);
  /// When point `index` (from 0, counted since the start) is measured, and at which clockwise
  /// angle.
  [[nodiscard]] Duration point_time(std::int64_t index) const;
  [[nodiscard]] std::uint16_t point_angle_cdeg(std::int64_t index) const;

 private:
  void measure(std::size_t slot, Duration when, const World& world, const Vehicle& vehicle);

  Ld06ModelConfig config_;
  Timestamp start_;
  Random random_;
  std::int64_t next_point_ = 0;
  Ld06Packet packet_{};
};

}  // namespace picolo::inline v0::sim
