// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Everything about the controller that is configuration. Plain aggregates: host tools fill them
/// from TOML.
#pragma once

#include <cstdint>

#include "picolo/controller/plausibility.hpp"
#include "picolo/core/time.hpp"
#include "picolo/executive/task.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/localisation/health.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/localisation/pose_trust.hpp"
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
  /// Of SearchConfig::lookups_per_step lookups, in the background.
  std::uint32_t max_search_slices = 4;
  /// Undistortion, match and map update never work in the same frame, so that each may have the
  /// time of all three.
  bool one_stage_a_frame = false;
  [[nodiscard]] constexpr bool valid() const {
    return max_can_frames > 0 && max_serial_bytes > 0 && max_returns > 0 &&
           max_point_iterations > 0 && max_rays > 0 && max_search_slices > 0;
  }
};

/// Time budgets of the tasks, for the overrun counters; together at most one minor frame.
struct TaskBudgets {
  Duration can{300};
  Duration serial{500};
  Duration odometry{200};
  Duration undistort{600};
  Duration match{1400};
  Duration map{1000};
  Duration background{600};
  Duration report{400};
};

/// What an overrun of each task means. A task that is bounded by its work but waits for a device
/// (a flash, a bus) may deserve more than a count.
struct TaskPolicies {
  OverrunPolicy can = OverrunPolicy::carry_on;
  OverrunPolicy serial = OverrunPolicy::carry_on;
  OverrunPolicy odometry = OverrunPolicy::carry_on;
  OverrunPolicy undistort = OverrunPolicy::carry_on;
  OverrunPolicy match = OverrunPolicy::carry_on;
  OverrunPolicy map = OverrunPolicy::carry_on;
  OverrunPolicy background = OverrunPolicy::carry_on;
  OverrunPolicy report = OverrunPolicy::carry_on;
};

/// How well a command that sets the pose knows it: standard deviations.
struct SetPoseSigma {
  float position_m = 0.1F;  ///< along each axis
  float heading_rad = 0.05F;
  /// At the start the pose is what the configuration says; until the gyro's bias is known the
  /// heading runs away by so much.
  float start_heading_rad = 0.003F;
  [[nodiscard]] constexpr bool valid() const {
    return position_m >= 0.0F && heading_rad >= 0.0F && start_heading_rad >= 0.0F;
  }
};

/// Identifiers of the controller's own frames (16 from the base on) and of the commands to it (the
/// next 16); 0x101 to 0x17F are free in every CANopen network.
struct FramesOutConfig {
  bool enabled = true;  ///< false: neither frames nor commands
  std::uint16_t base_id = 0x110;
  [[nodiscard]] constexpr bool valid() const { return base_id % 16 == 0 && base_id <= 0x7E0; }
};

/// Without wheels, but with a lidar, the odometry goes on with the velocity that the last matches
/// showed, and with the gyro's turn.
struct CoastConfig {
  bool enabled = true;
  Duration after = 100ms;  ///< without a sample of the wheels
  Duration behind = 10ms;  ///< the present: what the gyro measured has arrived by then
  Duration max_age =
      500ms;  ///< of the last accepted match; after that the vehicle is held to stand
  [[nodiscard]] constexpr bool valid() const {
    return after > Duration{0} && behind >= Duration{0} && max_age > Duration{0};
  }
};

struct ControllerConfig {
  ExecutiveConfig cycle{};
  WorkBounds work{};
  TaskBudgets budgets{};
  TaskPolicies policies{};
  DifferentialDriveConfig drive{};
  DeadReckoningConfig dead_reckoning{};
  SweepAssemblerConfig sweeps{};
  UndistortConfig undistort{};  ///< base_T_lidar is here
  LocaliserConfig localiser{};
  SetPoseSigma set_pose{};
  PlausibilityConfig plausibility{};
  MatchTrust trust{};
  HealthConfig health{};
  FramesOutConfig frames_out{};
  Pose2d start_map_T_base{};  ///< where the vehicle stands when the controller starts
  /// The published pose runs ahead of the odometry by at most this.
  Duration max_prediction = 25ms;
  /// A gap of the wheels up to this long is bridged with their last velocity and the gyro's turn.
  Duration max_bridge = 200ms;
  CoastConfig coast{};
  /// The lidar measured so long before its stamps say, on the wheels' clock; see calibration.
  Duration lidar_age{0};
  [[nodiscard]] constexpr bool valid() const;
};

/// Order of the task table; the index in events and counters.
enum class ControllerTask : std::uint8_t {
  can,
  serial,
  odometry,
  undistort,
  match,
  map,
  background,
  report
};
inline constexpr std::size_t kControllerTasks = 8;

/// The static table: who runs when, bounded by what.
[[nodiscard]] constexpr TaskTable<kControllerTasks> controller_tasks(
    const WorkBounds& work, const TaskBudgets& budgets, const TaskPolicies& policies = {}) {
  return {TaskEntry{.name = "can",
                    .work_bound = work.max_can_frames,
                    .budget = budgets.can,
                    .policy = policies.can},
          TaskEntry{.name = "serial",
                    .work_bound = work.max_serial_bytes,
                    .budget = budgets.serial,
                    .policy = policies.serial},
          TaskEntry{.name = "odometry", .budget = budgets.odometry, .policy = policies.odometry},
          TaskEntry{.name = "undistort",
                    .work_bound = work.max_returns,
                    .budget = budgets.undistort,
                    .policy = policies.undistort},
          TaskEntry{.name = "match",
                    .work_bound = work.max_point_iterations,
                    .budget = budgets.match,
                    .policy = policies.match,
                    .alternative = work.one_stage_a_frame},
          TaskEntry{.name = "map",
                    .work_bound = work.max_rays,
                    .budget = budgets.map,
                    .policy = policies.map,
                    .alternative = work.one_stage_a_frame},
          TaskEntry{.name = "background",
                    .work_bound = work.max_search_slices,
                    .budget = budgets.background,
                    .policy = policies.background},
          TaskEntry{.name = "report",
                    .period_frames = 5,
                    .offset_frames = 4,
                    .budget = budgets.report,
                    .policy = policies.report}};
}

constexpr bool ControllerConfig::valid() const {
  return valid_table(cycle, controller_tasks(work, budgets)) && work.valid() && drive.valid() &&
         dead_reckoning.valid() && sweeps.max_gap > Duration{0} && sweeps.valid() &&
         undistort.valid() && undistort.frame == SweepFrame::base &&
         undistort.reference != SweepReference::stamp && localiser.valid() && set_pose.valid() &&
         plausibility.valid() && trust.valid() && health.valid() && frames_out.valid() &&
         max_prediction >= Duration{0} && max_bridge >= Duration{0} && coast.valid();
}
static_assert(ControllerConfig{}.valid());

}  // namespace picolo::inline v0
