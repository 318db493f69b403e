// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/last_words.hpp"

namespace picolo::inline v0 {

std::uint32_t LastWords::seal() const {
  constexpr std::uint32_t kMagic = 0x4C575231U;  // changes with the layout of ResetReport
  std::uint32_t mixed = kMagic;
  const auto mix = [&mixed](std::uint32_t word) { mixed = (mixed ^ word) * 2654435761U; };
  mix(static_cast<std::uint32_t>(report_.cause));
  mix(report_.task);
  mix(report_.frames);
  mix(report_.slipped);
  mix(report_.overruns);
  mix(report_.resets);
  mix(noted_);
  return mixed;
}

void LastWords::note(const Schedule& schedule, Timestamp now) {
  const std::uint8_t stuck_in = schedule.stuck_in(now);
  const bool stuck = stuck_in != Schedule::kNoTask;
  report_.cause = stuck                ? ResetCause::stuck
                  : schedule.faulted() ? ResetCause::fault
                                       : ResetCause::starved;
  report_.task = stuck ? stuck_in : schedule.overran();
  report_.frames = schedule.frame_counters().frames;
  report_.slipped = schedule.frame_counters().slipped;
  report_.overruns = schedule.overruns();
  ++report_.resets;
  noted_ = 1;
  seal_ = seal();
}

Result<ResetReport> LastWords::take(EventRing& events) {
  if (seal_ != seal()) {
    report_ = {};
    noted_ = 0;
  }
  const bool noted = noted_ != 0;
  noted_ = 0;
  seal_ = seal();
  if (!noted) { return Status::not_ready; }
  static_cast<void>(events.attach());
  const std::int32_t task = report_.task == Schedule::kNoTask ? -1 : report_.task;
  events.push({.stamp_us = 0,
               .argument = task,
               .code = EventCode::watchdog_reset,
               .from = HealthState::initialising,
               .to = HealthState::initialising,
               .reason = HealthReason::none});
  return report_;
}

}  // namespace picolo::inline v0
