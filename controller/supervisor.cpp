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

bool Supervisor::matched(const MatchVerdict& verdict, const PoseCorrection& correction) {
  // Where the pose was guessed, or searched for, a correction contradicts nothing.
  const bool compared = !verdict.guessed && !verdict.relocalised;
  const bool leapt = correction.leapt && compared;
  trust_.matched({.accepted = verdict.accepted,
                  .rejection = verdict.rejection,
                  .inlier_share = verdict.inlier_share,
                  .agreement = verdict.agreement,
                  .jumped = correction.jumped && compared,
                  .pulled = correction.pulled && compared,
                  .leapt = leapt});
  if (verdict.accepted) { direction_unobservable_ = verdict.direction_unobservable; }
  return leapt;
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
  trust_.reset();
  trust_.distrust();
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
  return turns_disagree_ || trust_.disagrees(searching_) || (doubts_ & kOfThePose) != 0;
}

void Supervisor::update(Timestamp now, const PoseEstimate& estimate, const Schedule& schedule) {
  report_cycle(now, schedule);
  const Duration unmatched = estimate.match_age + (now - estimate.stamp);
  const bool contradicted_now = contradicted();
  trust_.update(contradicted_now, estimate.matches > 0 ? unmatched : Duration{0});
  const HealthReason reason_before = monitor_.reason();
  const HealthTransition transition = monitor_.update(
      {.now = now,
       .lidar_age = age(DeviceIndex::lidar, now),
       .wheels_age = age(DeviceIndex::wheels, now),
       .gyro_age = age(DeviceIndex::imu, now),
       .match_age = unmatched,
       .accepted_streak = trust_.accepted_streak(),
       .rejected_streak = trust_.rejected_streak(),
       .rejection = trust_.rejection(),
       .direction_unobservable = direction_unobservable_,
       .sensors_disagree = trust_.proving() || contradicted_now,
       .tilted = tilted_,
       .turn_unverified = turn_unverified_,
       .relocalising = searching_,
       .unproven = trust_.unproven(),
       .unverified = unverified_ && trust_.unproven(),
       .ambiguous = ambiguous_,
       .position_variance_m2 = estimate.match_covariance(0, 0) + estimate.match_covariance(1, 1),
       .overruns = cycle_troubles_,
       .cycle_fault = schedule.faulted(),
       .configuration_refused = configuration_refused_});
  const bool lost =
      transition.to == HealthState::lost || transition.to == HealthState::relocalising;
  const bool was_lost =
      transition.from == HealthState::lost || transition.from == HealthState::relocalising;
  if (lost && !was_lost) { trust_.distrust(); }
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
