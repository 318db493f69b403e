// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From one odometry pose to the next by counts alone: turn, drive, turn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0::sim {

struct WheelScriptConfig {
  double metres_per_count = 0.00005;
  double track_m = 0.5;
  double max_speed_mps = 2.0;
  double max_omega_radps = 3.0;
  /// Standing between two movements: at least one SYNC must fall into it, so that no sample of the
  /// counters spans a turn and a drive.
  Duration dwell = 20ms;
  [[nodiscard]] constexpr bool valid() const {
    return metres_per_count > 0.0 && track_m > metres_per_count && max_speed_mps > 0.0 &&
           max_omega_radps > 0.0 && dwell > Duration{0};
  }
};

/// Both wheels move by equal counts, forward or against each other, so that any odometry which
/// integrates whole samples gets exactly the same pose, whenever it samples. What a step's whole
/// counts cannot express is made up for by the next step: the error never accumulates.
class WheelScript {
 public:
  WheelScript(const WheelScriptConfig& config, const Pose2d& odom_T_start);

  /// Plans the way to `odom_T_goal`, from `begin` on; returns when the vehicle stands there.
  /// Drives backwards when that needs less turning. Precondition: the previous way has ended by
  /// `begin`.
  Timestamp go(const Pose2d& odom_T_goal, Timestamp begin);

  /// Cumulative counts, left and right; standing outside of the current way.
  [[nodiscard]] std::array<std::int64_t, 2> counts_at(Timestamp instant) const;
  /// Counts per second of each wheel.
  [[nodiscard]] std::array<std::int64_t, 2> rates_at(Timestamp instant) const;
  /// What the counts say at the end of the current way.
  [[nodiscard]] const Pose2d& odom_T_base() const { return odom_T_base_; }

 private:
  /// The wheels go by `counts` and `sign * counts`.
  struct Move {
    Timestamp begin{};
    Timestamp end{};
    std::int64_t counts = 0;  ///< of the right wheel
    int left_sign = 1;
  };

  void add_turn(std::size_t index, double angle_rad, Timestamp begin);
  void add_drive(std::size_t index, double distance_m, Timestamp begin);

  WheelScriptConfig config_;
  Pose2d odom_T_base_;
  std::array<std::int64_t, 2> base_{};  ///< counts at the beginning of the current way
  std::array<Move, 3> moves_{};
};

}  // namespace picolo::inline v0::sim
