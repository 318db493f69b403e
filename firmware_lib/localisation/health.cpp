// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/health.hpp"

#include <algorithm>

namespace picolo::inline v0 {

const char* to_string(HealthState state) {
  switch (state) {
    case HealthState::initialising: return "initialising";
    case HealthState::tracking: return "tracking";
    case HealthState::degraded: return "degraded";
    case HealthState::lost: return "lost";
    case HealthState::fault: return "fault";
    case HealthState::relocalising: return "relocalising";
  }
  return "unknown";
}

const char* to_string(HealthReason reason) {
  switch (reason) {
    case HealthReason::none: return "none";
    case HealthReason::starting: return "starting";
    case HealthReason::lidar_silent: return "lidar_silent";
    case HealthReason::wheels_silent: return "wheels_silent";
    case HealthReason::gyro_silent: return "gyro_silent";
    case HealthReason::match_rejected: return "match_rejected";
    case HealthReason::direction_unobservable: return "direction_unobservable";
    case HealthReason::too_few_points: return "too_few_points";
    case HealthReason::out_of_map: return "out_of_map";
    case HealthReason::relocalising: return "relocalising";
    case HealthReason::configuration: return "configuration";
    case HealthReason::overrun: return "overrun";
    case HealthReason::sensors_disagree: return "sensors_disagree";
    case HealthReason::tilted: return "tilted";
    case HealthReason::turn_unverified: return "turn_unverified";
    case HealthReason::ambiguous: return "ambiguous";
    case HealthReason::unproven: return "unproven";
  }
  return "unknown";
}

// The first cause that holds is the reason, worst first.
HealthMonitor::Finding HealthMonitor::assess(const HealthInputs& inputs) {
  if (inputs.overruns != overruns_) {
    if (inputs.now - overruns_since_ > config_.overrun_hold) {
      overruns_since_ = inputs.now;
      recent_overruns_ = 0;
    }
    recent_overruns_ += inputs.overruns - overruns_;
    overruns_ = inputs.overruns;
    if (recent_overruns_ > config_.tolerated_overruns) {
      last_overrun_ = inputs.now;
      overrun_seen_ = true;
    }
  }
  const bool lidar_silent = inputs.lidar_age > config_.max_lidar_age;
  const bool wheels_silent = inputs.wheels_age > config_.max_wheels_age;
  const bool blind = std::min(inputs.match_age, inputs.wheels_age) > config_.max_blind;
  const bool vague = !(inputs.position_variance_m2 <= config_.max_position_variance_m2);
  const bool overrun = overrun_seen_ && inputs.now - last_overrun_ <= config_.overrun_hold;

  if (inputs.configuration_refused) { return {Level::broken, HealthReason::configuration}; }
  if (inputs.cycle_fault) { return {Level::broken, HealthReason::overrun}; }
  if (blind) {
    return {Level::lost, lidar_silent ? HealthReason::lidar_silent : HealthReason::wheels_silent};
  }
  if (inputs.unverified) {
    return {Level::lost, inputs.ambiguous ? HealthReason::ambiguous : HealthReason::relocalising};
  }
  const bool contradicted = inputs.rejection != HealthReason::too_few_points;
  if (inputs.rejected_streak >= config_.lost_rejections && contradicted) {
    return {Level::lost, inputs.rejection};
  }
  if (vague) {
    return {Level::lost, lidar_silent ? HealthReason::lidar_silent : HealthReason::match_rejected};
  }
  if (lidar_silent) { return {Level::impaired, HealthReason::lidar_silent}; }
  if (wheels_silent) { return {Level::impaired, HealthReason::wheels_silent}; }
  if (inputs.sensors_disagree) { return {Level::impaired, HealthReason::sensors_disagree}; }
  if (inputs.tilted) { return {Level::impaired, HealthReason::tilted}; }
  if (inputs.rejected_streak >= config_.degraded_rejections) {
    return {Level::impaired, inputs.rejection};
  }
  if (inputs.unproven) { return {Level::impaired, HealthReason::unproven}; }
  if (inputs.match_age > config_.max_match_age) {
    return {Level::impaired,
            inputs.relocalising ? HealthReason::relocalising : HealthReason::match_rejected};
  }
  if (inputs.direction_unobservable) {
    return {Level::impaired, HealthReason::direction_unobservable};
  }
  if (config_.expects_gyro && inputs.gyro_age > config_.max_gyro_age) {
    return {Level::impaired, HealthReason::gyro_silent};
  }
  if (inputs.turn_unverified) { return {Level::impaired, HealthReason::turn_unverified}; }
  if (overrun) { return {Level::impaired, HealthReason::overrun}; }
  return {};
}

HealthTransition HealthMonitor::update(const HealthInputs& inputs) {
  const Finding finding = assess(inputs);
  const bool clear = finding.level == Level::clear;
  if (clear && !was_clear_) { clear_since_ = inputs.now; }
  was_clear_ = clear;

  HealthTransition transition{.from = state_};
  const HealthReason reason_before = reason_;
  advance(inputs, finding);
  transition.to = state_;
  transition.reason = reason_;
  transition.state_changed = transition.from != transition.to;
  transition.reason_changed = reason_before != reason_;
  return transition;
}

void HealthMonitor::enter(HealthState state, HealthReason reason) {
  state_ = state;
  reason_ = reason;
}

// Without sweeps there is nothing to search with; between two searches it is relocalising all the
// same.
void HealthMonitor::lose(const HealthInputs& inputs, const Finding& finding) {
  const bool lost = finding.level == Level::lost;
  const bool blind = finding.reason == HealthReason::lidar_silent ||
                     (lost && (finding.reason == HealthReason::wheels_silent ||
                               finding.reason == HealthReason::too_few_points));
  if (blind) { return enter(HealthState::lost, finding.reason); }
  if (lost && finding.reason == HealthReason::ambiguous) {
    return enter(HealthState::relocalising, finding.reason);
  }
  if (inputs.relocalising || inputs.unverified || state_ == HealthState::relocalising) {
    return enter(HealthState::relocalising, HealthReason::relocalising);
  }
  enter(HealthState::lost, lost ? finding.reason : reason_);
}

void HealthMonitor::advance(const HealthInputs& inputs, const Finding& finding) {
  if (state_ == HealthState::fault) { return; }
  if (finding.level == Level::broken) { return enter(HealthState::fault, finding.reason); }
  const bool clear = finding.level == Level::clear;
  switch (state_) {
    case HealthState::initialising:
      if (finding.level == Level::lost || inputs.unproven ||
          inputs.accepted_streak < config_.initial_matches) {
        return enter(state_, clear ? HealthReason::starting : finding.reason);
      }
      return clear ? enter(HealthState::tracking, HealthReason::none)
                   : enter(HealthState::degraded, finding.reason);
    case HealthState::tracking:
    case HealthState::degraded:
      if (finding.level == Level::lost) { return lose(inputs, finding); }
      if (!clear) { return enter(HealthState::degraded, finding.reason); }
      if (inputs.accepted_streak >= config_.recover_matches &&
          inputs.now - clear_since_ >= config_.recover_after) {
        return enter(HealthState::tracking, HealthReason::none);
      }
      return;  // the cause is gone, but not for long enough
    case HealthState::lost:
    case HealthState::relocalising:
      if (finding.level != Level::lost && inputs.accepted_streak >= config_.relocalised_matches) {
        return enter(HealthState::degraded, clear ? HealthReason::relocalising : finding.reason);
      }
      return lose(inputs, finding);
    case HealthState::fault: return;
  }
}

void HealthMonitor::reset() {
  enter(HealthState::initialising, HealthReason::starting);
  was_clear_ = false;
}

}  // namespace picolo::inline v0
