// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/reporter.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

// The rarer messages share their period and take turns, so that no report is much longer.
constexpr std::uint8_t kRareEvery = can_table::kCounter.every;
static_assert(can_table::kMatchSigma.every == kRareEvery &&
              can_table::kDriftSigma.every == kRareEvery &&
              can_table::kCorrelation.every == kRareEvery &&
              can_table::kCalibration.every == kRareEvery &&
              can_table::kCalibrationHint.every == kRareEvery && kRareEvery == 4);

}  // namespace

void Reporter::send(const CanFrame& frame) {
  if (!enabled_) { return; }
  const bool taken = is_ok(can_.transmit(frame));
  ++(taken ? sent_ : refused_);
}

void Reporter::reply(const CommandReply& reply) {
  send(frames_.reply(reply));
}

void Reporter::read_events(const EventRing& events, std::uint16_t index) {
  const std::uint32_t oldest = events.overwritten();
  // The 16 bits that went over the wire, completed to the newest index that ends in them.
  const auto back = static_cast<std::uint16_t>(events.total() - index);
  next_event_ = back > events.total() ? oldest : std::max(oldest, events.total() - back);
}

void Reporter::report(const ReportInputs& inputs) {
  tell_pose(inputs);
  tell_event(inputs.events);
  switch (reports_ % kRareEvery) {
    case 0:
      send(frames_.match_sigma(inputs.estimate));
      send(frames_.drift_sigma(inputs.estimate));
      break;
    case 1: send(frames_.correlation(inputs.estimate)); break;
    case 2: tell_counter(inputs.counters); break;
    default:
      if (inputs.calibration != nullptr) { tell_calibration(*inputs.calibration); }
      break;
  }
  ++reports_;
}

void Reporter::tell_pose(const ReportInputs& inputs) {
  send(frames_.pose(inputs.estimate));
  send(frames_.health(inputs.estimate, inputs.mode, inputs.now));
  send(frames_.twist(inputs.estimate));
  send(frames_.time(inputs.estimate));
}

void Reporter::tell_event(const EventRing& events) {
  const std::uint32_t oldest = events.overwritten();
  next_event_ = std::max(next_event_, oldest);
  if (next_event_ >= events.total()) { return; }
  const Event& event = events[next_event_ - oldest];
  send(frames_.event(event, next_event_));
  send(frames_.event_time(event, next_event_));
  ++next_event_;
}

void Reporter::tell_counter(const CounterValues& counters) {
  send(frames_.counter(static_cast<CounterIndex>(next_counter_), counters[next_counter_]));
  next_counter_ = static_cast<std::uint8_t>((next_counter_ + 1U) % kCounterCount);
}

void Reporter::tell_calibration(const CalibrationService& calibration) {
  const CalibrationProgress progress = calibration.progress();
  if (progress.phase == CalibrationPhase::idle) { return; }
  send(frames_.calibration(progress));
  const CalibrationHint hint = calibration.hint();
  if (hint.advice != DriveAdvice::none) { send(frames_.calibration_hint(hint)); }
  const std::size_t values = calibration.value_count();
  if (values == 0) { return; }
  if (next_value_ >= values) { next_value_ = 0; }
  send(frames_.calibration_value(calibration.value(next_value_)));
  ++next_value_;
}

}  // namespace picolo::inline v0
