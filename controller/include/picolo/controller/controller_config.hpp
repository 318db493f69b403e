// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Everything about the controller that is configuration. Plain aggregates: host tools fill them
/// from TOML.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/executive/task.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/localisation/health.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/odometry/dead_reckoning.hpp"
#include "picolo/odometry/differential_drive.hpp"
#include "picolo/sensing/sweep.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

/// How much of each kind of work one minor frame may do. The defaults finish a sweep of 720 returns
/// at 10 Hz before the next one, with room to spare.
struct WorkBounds {
  std::uint32_t max_can_frames = 32;          ///< 5 ms hold 23 frames at 500 kbit/s
  std::uint32_t max_serial_bytes = 512;       ///< a line; 5 ms hold 115 bytes at 230400 baud
  std::uint32_t max_returns = 384;            ///< undistorted
  std::uint32_t max_point_iterations = 2880;  ///< of the match; at least one iteration is done
  std::uint32_t max_rays = 128;               ///< into the map
  [[nodiscard]] constexpr bool valid() const {
    return max_can_frames > 0 && max_serial_bytes > 0 && max_returns > 0 &&
           max_point_iterations > 0 && max_rays > 0;
  }
};

/// Time budgets of the tasks, for the overrun counters; together at most one minor frame.
struct TaskBudgets {
  Duration can{300};
  Duration serial{500};
  Duration odometry{200};
  Duration undistort{600};
  Duration match{1800};
  Duration map{1200};
  Duration report{400};
};

/// How the uncertainty of the published pose grows with the way since the last match, and that of
/// the map with the way since the start. Standard deviations proportional to the way: wheels and
/// gyro err systematically.
struct CovarianceGrowth {
  float position_per_m = 0.05F;  ///< since the match
  float position_per_rad_m = 0.01F;
  float heading_per_m_rad = 0.01F;
  float heading_per_rad = 0.02F;
  float drift_per_m = 0.005F;  ///< since the start
  float drift_heading_per_m_rad = 0.001F;
  [[nodiscard]] constexpr bool valid() const {
    return position_per_m >= 0.0F && position_per_rad_m >= 0.0F && heading_per_m_rad >= 0.0F &&
           heading_per_rad >= 0.0F && drift_per_m >= 0.0F && drift_heading_per_m_rad >= 0.0F;
  }
};

/// Identifiers of the controller's own frames; 0x101 to 0x17F are free in every CANopen network.
struct FramesOutConfig {
  bool enabled = true;
  std::uint16_t pose_id = 0x110;
  std::uint16_t health_id = 0x111;
  [[nodiscard]] constexpr bool valid() const {
    return pose_id <= 0x7FF && health_id <= 0x7FF && pose_id != health_id;
  }
};

struct ControllerConfig {
  ExecutiveConfig cycle{};
  WorkBounds work{};
  TaskBudgets budgets{};
  DifferentialDriveConfig drive{};
  DeadReckoningConfig dead_reckoning{};
  SweepAssemblerConfig sweeps{};
  UndistortConfig undistort{};  ///< base_T_lidar is here
  LocaliserConfig localiser{};
  CovarianceGrowth growth{};
  HealthConfig health{};
  FramesOutConfig frames_out{};
  Pose2d start_map_T_base{};  ///< where the vehicle stands when the controller starts
  /// The published pose runs ahead of the odometry by at most this.
  Duration max_prediction = 25ms;
  float min_jump_event_m = 0.05F;     ///< corrections that move the pose further are told as events
  float min_jump_event_rad = 0.035F;  ///< ... or turn it further
  [[nodiscard]] constexpr bool valid() const;
};

/// Order of the task table; the index in events and counters.
enum class ControllerTask : std::uint8_t { can, serial, odometry, undistort, match, map, report };
inline constexpr std::size_t kControllerTasks = 7;

/// The static table: who runs when, bounded by what.
[[nodiscard]] constexpr TaskTable<kControllerTasks> controller_tasks(const WorkBounds& work,
                                                                     const TaskBudgets& budgets) {
  return {
      TaskEntry{.name = "can", .work_bound = work.max_can_frames, .budget = budgets.can},
      TaskEntry{.name = "serial", .work_bound = work.max_serial_bytes, .budget = budgets.serial},
      TaskEntry{.name = "odometry", .budget = budgets.odometry},
      TaskEntry{.name = "undistort", .work_bound = work.max_returns, .budget = budgets.undistort},
      TaskEntry{.name = "match", .work_bound = work.max_point_iterations, .budget = budgets.match},
      TaskEntry{.name = "map", .work_bound = work.max_rays, .budget = budgets.map},
      TaskEntry{
          .name = "report", .period_frames = 5, .offset_frames = 4, .budget = budgets.report}};
}

constexpr bool ControllerConfig::valid() const {
  return valid_table(cycle, controller_tasks(work, budgets)) && work.valid() && drive.valid() &&
         dead_reckoning.valid() && sweeps.max_gap > Duration{0} && sweeps.valid() &&
         undistort.valid() && undistort.frame == SweepFrame::base &&
         undistort.reference != SweepReference::stamp && localiser.valid() && growth.valid() &&
         health.valid() && frames_out.valid() && max_prediction >= Duration{0} &&
         min_jump_event_m >= 0.0F && min_jump_event_rad >= 0.0F;
}
static_assert(ControllerConfig{}.valid());

}  // namespace picolo::inline v0
