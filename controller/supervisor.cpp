// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/supervisor.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr Duration kEventPause = 1s;
// Nothing of the pose comes from the accelerometer.
constexpr SensorDoubts kOfThePose =
    static_cast<SensorDoubts>(~doubt_of(SensorIndex::accelerometer));
constexpr int kDoubtful = 2;  // steps that a doubtful match raises what any other lowers by one

void count_up(int& streak) {
  if (streak < std::numeric_limits<int>::max()) { ++streak; }
}

std::int32_t saturated(std::uint32_t count) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::min(count, kMost));
}

}  // namespace

void Supervisor::start(Timestamp now, bool kept) {
  for (Watch& watch : watches_) { watch.last = now; }
  event(now, EventCode::started, kept ? 1 : 0);
}

void Supervisor::event(Timestamp now, EventCode code, std::int32_t argument) {
  events_.push({.stamp_us = now.time_since_epoch().count(),
                .argument = argument,
                .code = code,
                .from = monitor_.state(),
                .to = monitor_.state(),
                .reason = monitor_.reason()});
}

void Supervisor::heard(DeviceIndex device, Timestamp stamp) {
  Watch& watch = watches_[static_cast<std::size_t>(device)];
  watch.last = std::max(watch.last, stamp);
}

void Supervisor::line(DeviceIndex device, Status status, Timestamp now) {
  Watch& watch = watches_[static_cast<std::size_t>(device)];
  const bool connected = status != Status::disconnected;
  if (connected == watch.connected) { return; }
  watch.connected = connected;
  event(now, connected ? EventCode::device_back : EventCode::device_lost,
        static_cast<std::int32_t>(device));
}

void Supervisor::matched(const MatchVerdict& verdict, bool jumped, bool pulled) {
  if (!verdict.accepted) {
    count_up(rejected_streak_);
    accepted_streak_ = 0;
    rejection_ = verdict.rejection;
    return;
  }
  rejected_streak_ = 0;
  direction_unobservable_ = verdict.direction_unobservable;
  const bool poor = verdict.inlier_share < trust_.good_inlier_share ||
                    (unproven_ && verdict.agreement < trust_.found_again_agreement);
  if (poor || jumped) {
    accepted_streak_ = 0;
  } else {
    count_up(accepted_streak_);
  }
  if (accepted_streak_ >= trust_.found_again_matches) { unproven_ = false; }
  if (jumped) {
    doubt_ += poor ? 2 * kDoubtful : kDoubtful;
  } else if (!poor) {  // a poor match in new surroundings says nothing
    doubt_ -= 1;
  }
  if (jumped) {
    proof_left_ = proof_left_ > 0 ? std::max(proof_left_, trust_.proof_matches) : 0;
  } else if (!poor) {
    proof_left_ = std::max(0, proof_left_ - 1);
    hold_left_ = std::max(0, hold_left_ - 1);
  }
  // A lidar that told the same for seconds has drawn the pose along.
  if (pulled && !unproven_ && !pulled_) {
    unproven_ = true;
    accepted_streak_ = 0;
  }
  pulled_ = pulled;
  doubt_ = std::clamp(doubt_, 0, trust_.max_doubt + 2 * kDoubtful);
}

void Supervisor::tell(Timestamp now, EventCode code, std::uint32_t count, Trouble& trouble) {
  // Without wheels every sweep is replaced: that must not push out of the ring why it came so far.
  if (count == trouble.told || (trouble.any && now - trouble.last < kEventPause)) { return; }
  trouble = {.told = count, .last = now, .any = true};
  event(now, code, saturated(count));
}

void Supervisor::sweeps(Timestamp now, std::uint32_t replaced, std::uint32_t dropped) {
  tell(now, EventCode::sweep_replaced, replaced, replaced_);
  tell(now, EventCode::sweep_dropped, dropped, dropped_);
}

void Supervisor::doubted(Timestamp now, SensorDoubts sensors) {
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const auto bit = doubt_of(static_cast<SensorIndex>(i));
    if ((sensors & bit) != 0 && (doubts_ & bit) == 0) {
      event(now, EventCode::sensor_doubted, static_cast<std::int32_t>(i));
    }
  }
  doubts_ = sensors;
}

void Supervisor::pose_set(Timestamp now) {
  monitor_.reset();
  accepted_streak_ = 0;
  rejected_streak_ = 0;
  doubt_ = 0;
  proof_left_ = 0;
  hold_left_ = 0;
  pulled_ = false;
  event(now, EventCode::pose_set, 0);
}

void Supervisor::report_cycle(Timestamp now, const Schedule& schedule) {
  for (std::size_t task = 0; task < overruns_.size() && task < schedule.size(); ++task) {
    const std::uint32_t overruns = schedule.counters(task).overruns;
    if (overruns == overruns_[task]) { continue; }
    cycle_troubles_ += overruns - overruns_[task];
    overruns_[task] = overruns;
    event(now, EventCode::overrun, static_cast<std::int32_t>(task));
  }
  const std::uint32_t slipped = schedule.frame_counters().slipped;
  if (slipped == slipped_) { return; }
  cycle_troubles_ += slipped - slipped_;
  event(now, EventCode::frames_slipped, saturated(slipped - slipped_));
  slipped_ = slipped;
}

bool Supervisor::contradicted() const {
  return turns_disagree_ || pulled_ || doubt_ > trust_.max_doubt || (doubt_ > 0 && searching_) ||
         (doubts_ & kOfThePose) != 0;
}

void Supervisor::update(Timestamp now, const PoseEstimate& estimate, const Schedule& schedule) {
  report_cycle(now, schedule);
  const Duration unmatched = estimate.match_age + (now - estimate.stamp);
  if (estimate.matches > 0 && unmatched > trust_.max_unmatched && !unproven_) {
    unproven_ = true;
    accepted_streak_ = 0;
  }
  const bool contradicted_now = contradicted();
  if (contradicted_now) {
    proof_left_ = std::max(proof_left_, pulled_ ? trust_.pull_proof_matches : trust_.proof_matches);
  }
  if (contradicted_now && !was_contradicted_) { hold_left_ = trust_.found_again_matches; }
  was_contradicted_ = contradicted_now;
  const HealthReason reason_before = monitor_.reason();
  const HealthTransition transition = monitor_.update(
      {.now = now,
       .lidar_age = age(DeviceIndex::lidar, now),
       .wheels_age = age(DeviceIndex::wheels, now),
       .gyro_age = age(DeviceIndex::imu, now),
       .match_age = unmatched,
       .accepted_streak = accepted_streak_,
       .rejected_streak = rejected_streak_,
       .rejection = rejection_,
       .direction_unobservable = direction_unobservable_,
       .sensors_disagree = proof_left_ > 0 || contradicted_now,
       .tilted = tilted_,
       .turn_unverified = turn_unverified_,
       .relocalising = searching_,
       .position_variance_m2 = estimate.match_covariance(0, 0) + estimate.match_covariance(1, 1),
       .overruns = cycle_troubles_,
       .cycle_fault = schedule.faulted(),
       .configuration_refused = configuration_refused_});
  if (transition.state_changed && transition.to == HealthState::lost) {
    unproven_ = true;
    accepted_streak_ = 0;
  }
  if (!transition.state_changed && !transition.reason_changed) { return; }
  events_.push(
      {.stamp_us = now.time_since_epoch().count(),
       .argument = transition.state_changed ? 0 : static_cast<std::int32_t>(reason_before),
       .code = transition.state_changed ? EventCode::state_changed : EventCode::reason_changed,
       .from = transition.from,
       .to = transition.to,
       .reason = transition.reason});
}

}  // namespace picolo::inline v0
