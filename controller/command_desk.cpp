// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/command_desk.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

bool is_number(const Pose2d& pose) {
  // not_available decodes to a NaN, which is unequal to itself
  return pose.x_m == pose.x_m && pose.y_m == pose.y_m && pose.theta_rad == pose.theta_rad;
}

CommandResult to_result(Status status) {
  if (status == Status::ok) { return CommandResult::done; }
  if (status == Status::invalid_argument) { return CommandResult::invalid_argument; }
  if (status == Status::not_ready) { return CommandResult::busy; }
  return status == Status::unsupported ? CommandResult::unsupported : CommandResult::failed;
}

}  // namespace

bool CommandDesk::consume(const CanFrame& frame, Timestamp now) {
  if (!enabled_ || frame.extended || frame.id < base_id_) { return false; }
  const std::uint32_t offset = frame.id - base_id_;
  if (offset >= kCanOwnIds + kCanCommandIds) { return false; }
  if (offset < kCanOwnIds) {
    // Ports do not hand out own frames: somebody else pretends to be us.
    ++impersonated_;
    supervisor_.impersonated(now, impersonated_);
    return true;
  }
  const Result<Receipt> receipt = gate_.check(frame, now);
  if (!receipt) { return false; }
  receive(*receipt, now);
  return true;
}

void CommandDesk::receive(const Receipt& receipt, Timestamp now) {
  const Command& command = receipt.command;
  if (receipt.verdict == CommandResult::done) {
    const CommandResult result = act(command, now);
    if (result != CommandResult::done && result != CommandResult::started) {
      gate_.count_refused();
    }
    answer(command, result);
    return;
  }
  // A sender gone wild must not fill the bus with answers, nor the ring with events.
  if (refusal_told_ && now == last_refusal_told_) { return; }
  last_refusal_told_ = now;
  refusal_told_ = true;
  const CommandCounters& counters = gate_.counters();
  supervisor_.command_refused(now, counters.corrupt + counters.repeated + counters.stale);
  answer(command, receipt.verdict);
}

void CommandDesk::answer(const Command& command, CommandResult result) {
  const CommandCounters& counters = gate_.counters();
  reporter_.reply(
      {.command = command.kind,
       .counter = command.counter,
       .result = result,
       .detail = command.detail,
       .accepted = counters.accepted,
       .refused = counters.corrupt + counters.repeated + counters.stale + counters.refused});
}

CommandResult CommandDesk::act(const Command& command, Timestamp now) {
  switch (command.kind) {
    case CommandKind::set_pose: return set_pose(command.map_T_base, now);
    case CommandKind::set_mode: return set_mode(command.detail, now);
    case CommandKind::save_map:
    case CommandKind::load_map: return begin_map_job(command);
    case CommandKind::start_calibration:
      if (services_.calibration == nullptr) { return CommandResult::unsupported; }
      return to_result(services_.calibration->start(command.detail, now));
    case CommandKind::abort_calibration:
      if (services_.calibration == nullptr) { return CommandResult::unsupported; }
      return to_result(services_.calibration->cancel(now));
    case CommandKind::read_events:
      reporter_.read_events(supervisor_.events(), command.index);
      return CommandResult::done;
  }
  return CommandResult::unsupported;
}

CommandResult CommandDesk::set_pose(const Pose2d& map_T_base, Timestamp now) {
  if (!is_number(map_T_base)) { return CommandResult::invalid_argument; }
  const StampedPose odometry = pipeline_.newest_pose(now);
  composer_.set_pose(map_T_base, odometry);
  pipeline_.set_pose(map_T_base * inverse(odometry.odom_T_base), composer_.set_pose_covariance());
  supervisor_.pose_set(now);
  return CommandResult::done;
}

CommandResult CommandDesk::set_mode(std::uint8_t mode, Timestamp now) {
  if (mode > static_cast<std::uint8_t>(OperatingMode::localising)) {
    return CommandResult::invalid_argument;
  }
  const auto wanted = static_cast<OperatingMode>(mode);
  // A map that was loaded is not changed any more.
  if (wanted == OperatingMode::mapping && pipeline_.localiser().localises_only()) {
    return CommandResult::unsupported;
  }
  mode_ = wanted;
  supervisor_.event(now, EventCode::mode_set, mode);
  return CommandResult::done;
}

CommandResult CommandDesk::begin_map_job(const Command& command) {
  if (services_.maps == nullptr) { return CommandResult::unsupported; }
  if (map_job_phase_ != MapJobPhase::none) { return CommandResult::busy; }
  map_job_ = command;
  map_job_phase_ = MapJobPhase::waiting;
  pipeline_.pause(true);
  return CommandResult::started;
}

Status CommandDesk::map_job_slice() {
  LocaliserCore& localiser = pipeline_.idle_localiser();
  if (map_job_phase_ == MapJobPhase::running) { return services_.maps->step(localiser); }
  const Status status = map_job_.kind == CommandKind::save_map
                            ? services_.maps->begin_save(map_job_.detail, localiser)
                            : services_.maps->begin_load(map_job_.detail, localiser);
  if (!is_ok(status)) { return status == Status::not_ready ? Status::corrupt : status; }
  map_job_phase_ = MapJobPhase::running;
  return Status::not_ready;
}

bool CommandDesk::serving() const {
  if (services_.calibration == nullptr) { return false; }
  const CalibrationPhase phase = services_.calibration->progress().phase;
  return phase != CalibrationPhase::idle && phase != CalibrationPhase::done &&
         phase != CalibrationPhase::refused && phase != CalibrationPhase::aborted;
}

void CommandDesk::work(Timestamp now) {
  if (services_.calibration != nullptr) { services_.calibration->step(now); }
  if (map_job_phase_ == MapJobPhase::none || !pipeline_.idle()) { return; }
  const Status status = map_job_slice();
  if (status == Status::not_ready) { return; }
  map_job_phase_ = MapJobPhase::none;
  pipeline_.pause(false);
  if (!is_ok(status)) {
    gate_.count_refused();
  } else if (map_job_.kind == CommandKind::load_map) {
    mode_ = OperatingMode::localising;
    // The pose stays what it was until it is set, but has to prove itself in the new map.
    static_cast<void>(
        set_pose(composer_.map_T_odom() * pipeline_.newest_pose(now).odom_T_base, now));
  }
  answer(map_job_, to_result(status));
}

}  // namespace picolo::inline v0
