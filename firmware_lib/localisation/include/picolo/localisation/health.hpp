// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far the pose may be trusted, decided in one place: initialising, tracking, degraded, lost,
/// relocalising, fault.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::inline v0 {

struct HealthConfig {
  Duration max_lidar_age = 250ms;   ///< since the last complete sweep; older is silence
  Duration max_wheels_age = 100ms;  ///< since the last wheel ticks
  Duration max_gyro_age = 100ms;    ///< since the last IMU sample
  Duration max_blind = 500ms;       ///< with neither lidar nor wheels: after that, lost
  Duration max_match_age = 300ms;   ///< since the last accepted match: degraded
  bool expects_gyro = true;         ///< false: its absence is no loss
  int initial_matches = 3;      ///< accepted in a row before the pose is trusted for the first time
  int degraded_rejections = 2;  ///< matches rejected in a row: degraded
  /// ... and lost, unless there are too few points to tell: that is no lidar, not a contradiction.
  int lost_rejections = 15;
  float max_position_variance_m2 = 0.25F;  ///< of the pose in the map; beyond it, lost
  int recover_matches = 3;                 ///< accepted in a row, and
  /// This long without any cause, before degraded becomes tracking.
  Duration recover_after = 500ms;
  int relocalised_matches = 5;  ///< accepted in a row before lost becomes degraded
  Duration overrun_hold = 1s;   ///< how long an overrun of the cycle is held against the pose
  /// So many within overrun_hold are not: for systems without a real-time scheduler.
  std::uint32_t tolerated_overruns = 0;

  [[nodiscard]] constexpr bool valid() const {
    return max_lidar_age > Duration{0} && max_wheels_age > Duration{0} &&
           max_gyro_age > Duration{0} && max_blind >= max_lidar_age &&
           max_blind >= max_wheels_age && max_match_age > Duration{0} && initial_matches > 0 &&
           degraded_rejections > 0 && lost_rejections > degraded_rejections &&
           max_position_variance_m2 > 0.0F && recover_matches > 0 && recover_after >= Duration{0} &&
           relocalised_matches > 0 && overrun_hold >= Duration{0};
  }
};

/// What the monitor is told at each update. Ages count from the start as long as nothing came.
struct HealthInputs {
  Timestamp now{};
  Duration lidar_age{};
  Duration wheels_age{};
  Duration gyro_age{};
  Duration match_age{};     ///< since the reference instant of the last accepted match
  int accepted_streak = 0;  ///< matches accepted since the last rejected one
  int rejected_streak = 0;  ///< matches rejected since the last accepted one
  HealthReason rejection = HealthReason::match_rejected;  ///< why the last one was rejected
  bool direction_unobservable = false;  ///< the last accepted match left a direction to odometry
  bool sensors_disagree = false;        ///< wheels, gyro and lidar tell different motions
  bool tilted = false;                  ///< the vehicle leans; sweeps show the floor
  bool turn_unverified = false;         ///< the wheels alone turned too far since the last match
  bool relocalising = false;            ///< a wide search is running
  bool unproven = false;    ///< the pose was doubted, and has not yet been seen to fit again
  bool unverified = false;  ///< the pose may be anywhere: only a search of the whole map can tell
  bool ambiguous = false;   ///< ... which has found several places
  /// Larger eigenvalue or trace of the position part; a NaN counts as too large.
  float position_variance_m2 = 0.0F;
  std::uint32_t overruns = 0;  ///< of the cycle since start, modulo 2^32
  bool cycle_fault = false;    ///< the executive gave up
  bool configuration_refused = false;
};

struct HealthTransition {
  HealthState from = HealthState::initialising;
  HealthState to = HealthState::initialising;
  HealthReason reason = HealthReason::starting;  ///< after the update
  bool state_changed = false;
  bool reason_changed = false;
};

/// Falls at once, rises only after matches in a row and a time without cause; fault is left by
/// `reset` alone. Cost: `update` O(1). Context: cycle only.
class HealthMonitor {
 public:
  explicit HealthMonitor(const HealthConfig& config) : config_(config) {}

  /// Stamps must not decrease. The caller writes transitions into the event ring.
  HealthTransition update(const HealthInputs& inputs);
  /// Back to initialising, for a new start of the pose.
  void reset();

  [[nodiscard]] HealthState state() const { return state_; }
  [[nodiscard]] HealthReason reason() const { return reason_; }

 private:
  enum class Level : std::uint8_t { clear, impaired, lost, broken };
  struct Finding {
    Level level = Level::clear;
    HealthReason reason = HealthReason::none;
  };

  [[nodiscard]] Finding assess(const HealthInputs& inputs);
  void advance(const HealthInputs& inputs, const Finding& finding);
  void enter(HealthState state, HealthReason reason);
  void lose(const HealthInputs& inputs, const Finding& finding);

  HealthConfig config_;
  HealthState state_ = HealthState::initialising;
  HealthReason reason_ = HealthReason::starting;
  Timestamp clear_since_{};            // valid while was_clear_
  Timestamp last_overrun_{};           // valid while overrun_seen_
  Timestamp overruns_since_{};         // a window as long as overrun_hold, and ...
  std::uint32_t recent_overruns_ = 0;  // ... how many came in it
  std::uint32_t overruns_ = 0;
  bool was_clear_ = false;
  bool overrun_seen_ = false;
};

}  // namespace picolo::inline v0
