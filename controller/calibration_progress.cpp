// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the routine knows about what it lacks, and what it tells the driver.

#include <algorithm>

#include "picolo/controller/calibration_routine.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr int kMaxRestarts = 4;
constexpr std::uint64_t kEncodersCertain = 100;  // samples

bool is_encoder(RefusalReason reason) {
  return reason == RefusalReason::encoder_disconnected ||
         reason == RefusalReason::encoder_swapped || reason == RefusalReason::encoder_reversed;
}

}  // namespace

const char* to_string(CalibrationPhase phase) {
  switch (phase) {
    case CalibrationPhase::idle: return "idle";
    case CalibrationPhase::standstill: return "standstill";
    case CalibrationPhase::collecting: return "collecting";
    case CalibrationPhase::checking: return "checking";
    case CalibrationPhase::solving: return "solving";
    case CalibrationPhase::verifying: return "verifying";
    case CalibrationPhase::saving: return "saving";
    case CalibrationPhase::done: return "done";
    case CalibrationPhase::refused: return "refused";
    case CalibrationPhase::aborted: return "aborted";
  }
  return "unknown";
}

const char* to_string(DriveAdvice advice) {
  switch (advice) {
    case DriveAdvice::none: return "nothing to drive";
    case DriveAdvice::stand_still: return "stand still";
    case DriveAdvice::turn_left: return "turn on the spot to the left";
    case DriveAdvice::turn_right: return "turn on the spot to the right";
    case DriveAdvice::drive_straight: return "drive a straight of 3 m";
    case DriveAdvice::change_speed: return "turn to and fro, briskly";
    case DriveAdvice::drive_on: return "drive on, with turns";
  }
  return "unknown";
}

void CalibrationRoutine::set(Parameter parameter, double share, RefusalReason reason) {
  const auto index = static_cast<std::size_t>(parameter);
  const double percent = 100.0 * std::min(1.0, std::max(0.0, share));
  percent_[index] = static_cast<std::uint8_t>(floor_to_i32(percent, 0, 100));
  lacks_[index] = percent_[index] == 100 ? RefusalReason::none : reason;
}

/// One look each time, in pieces, so that each costs little.
void CalibrationRoutine::look(Timestamp now) {
  switch (look_) {
    case 0:
      if (!solved_joint()) { return; }
      break;
    case 1:
      if (!solved(lidar_clock_.core(), offset_report_)) { return; }
      if (!offset_report_.refusal) { follow_offset(); }
      break;
    case 2:
      if (!looked_at_gyro()) { return; }
      break;
    default: look_at_progress(); break;
  }
  const Refusal judged = joint_.check().judge(config_.joint.needs);
  // No driving on will mend a wire.
  if (is_encoder(judged.reason) && joint_.check().samples() >= kEncodersCertain &&
      now - entered_ > Duration{0}) {
    refuse(judged);
  }
}

/// A slice of the joint solution; true after the last.
bool CalibrationRoutine::solved_joint() {
  switch (solving_) {
    case 0: solving_ = is_ok(joint_.solve_drive(report_)) ? 1 : 0; break;
    case 1:
      joint_.solve_information(report_);
      solving_ = 2;
      break;
    default:
      static_cast<void>(joint_.solve_deviations(report_, false));
      solving_ = 0;
      break;
  }
  return solving_ == 0;
}

/// The same of a clock.
bool CalibrationRoutine::solved(TimeOffsetCore& clock, TimeOffsetReport& report) {
  if (solving_ == 0) { clock.begin_solution(); }
  solving_ = clock.solve_slice(config_.fits_per_step, report) ? 0 : 1;
  return solving_ == 0;
}

bool CalibrationRoutine::looked_at_gyro() {
  if (piece_ == 0) {
    if (solved(gyro_clock_.core(), gyro_offset_report_)) { piece_ = 1; }
    return false;
  }
  static_cast<void>(gyro_.solve(gyro_report_));
  static_cast<void>(mount_.solve(mount_report_));
  piece_ = 0;
  return true;
}

void CalibrationRoutine::follow_offset() {
  const Estimate& offset = offset_report_.offset_s;
  const double change = magnitude(offset.value - used_offset_s_);
  if (change <= std::max(config_.max_offset_change_s, 4.0 * offset.std) ||
      restarts_ == kMaxRestarts) {
    return;
  }
  // What was collected so far met the wheels at the wrong instants.
  ++restarts_;
  used_offset_s_ = offset.value;
  joint_.reset();
  gyro_.forget_turns();
  report_ = {};
}

/// (needed deviation / deviation)^2 of an element of the joint solution; 0 without one.
double CalibrationRoutine::information(std::size_t index, double target) const {
  const double variance = report_.covariance[7 * index];
  return variance > 0.0 ? target * target / variance : 0.0;
}

RefusalReason CalibrationRoutine::wheels_lack(const Refusal& judged, std::size_t index) const {
  if (!judged) { return RefusalReason::too_little_data; }
  const bool radius = index < 2;
  // Straight on, both radii together are seen; what tells them apart is the turn.
  if (judged.reason == RefusalReason::pure_rotation && !radius) {
    return RefusalReason::too_little_data;
  }
  return judged.reason;
}

void CalibrationRoutine::look_at_progress() {
  const MotionCheck& seen = joint_.check();
  const MotionNeeds& needs = config_.joint.needs;
  const Refusal judged = seen.judge(needs);
  const double less = std::min(seen.turned_left_rad(), seen.turned_right_rad());
  const double turns = std::min(1.0, less / needs.turn_each_way_rad);
  const double travel = std::min(1.0, seen.wheel_travel_rad() / needs.wheel_travel_rad);
  const DriveParameters& d = report_.drive;
  const double relative = config_.target_relative_std;
  const double most = judged ? 0.99 : 1.0;  // never complete while the drive does not suffice
  const auto wheel = [&](Parameter parameter, std::size_t index, double value, double shown) {
    set(parameter, std::min({most, shown, information(index, relative * value)}),
        wheels_lack(judged, index));
  };
  wheel(Parameter::wheel_radius_left, 0, d.radius_left_m, std::min(turns, travel));
  wheel(Parameter::wheel_radius_right, 1, d.radius_right_m, std::min(turns, travel));
  wheel(Parameter::track_width, 2, d.track_m, turns);
  const bool turned = seen.turned_left_rad() + seen.turned_right_rad() >= needs.min_turn_rad;
  const RefusalReason lever = turned ? (judged ? judged.reason : RefusalReason::too_little_data)
                                     : RefusalReason::straight_only;
  const double position = config_.target_position_std_m;
  set(Parameter::lidar_x, std::min({most, turns, information(3, position)}), lever);
  set(Parameter::lidar_y, std::min({most, turns, information(4, position)}), lever);
  const bool moved = travel >= 0.25 && seen.speed_share() >= 1e-3;
  set(Parameter::lidar_yaw, std::min({most, travel, information(5, config_.target_yaw_std_rad)}),
      moved ? RefusalReason::too_little_data : RefusalReason::no_translation);

  const auto clock = [&](Parameter parameter, const TimeOffsetReport& report) {
    const double std = report.offset_s.std;
    const double target = config_.target_offset_std_s;
    const RefusalReason reason =
        report.refusal ? report.refusal.reason : RefusalReason::too_little_data;
    set(parameter, report.refusal || !(std > 0.0) ? 0.0 : target * target / (std * std), reason);
  };
  clock(Parameter::time_offset, offset_report_);
  advice_ = choose_advice();
  if (!config_.use_gyro || !gyro_heard_) { return; }
  clock(Parameter::gyro_offset, gyro_offset_report_);
  set(Parameter::gyro_bias, gyro_report_.bias_refusal ? 0.0 : 1.0,
      gyro_report_.bias_refusal.reason);
  set(Parameter::gyro_yaw, mount_report_.refusal ? 0.0 : 1.0, mount_report_.refusal.reason);
  const double std = gyro_report_.scale.std;
  const double target = config_.target_scale_std;
  set(Parameter::gyro_scale,
      gyro_report_.scale_refusal || !(std > 0.0) ? 0.0 : target * target / (std * std),
      gyro_report_.scale_refusal ? gyro_report_.scale_refusal.reason
                                 : RefusalReason::too_little_data);
}

bool CalibrationRoutine::complete() const {
  for (std::size_t k = 1; k <= static_cast<std::size_t>(Parameter::time_offset); ++k) {
    if (percent_[k] < 100) { return false; }
  }
  return !config_.use_gyro || !gyro_heard_ ||
         percent_[static_cast<std::size_t>(Parameter::gyro_scale)] == 100;
}

DriveAdvice CalibrationRoutine::choose_advice() const {
  const MotionCheck& seen = joint_.check();
  const MotionNeeds& needs = config_.joint.needs;
  const bool left_next = seen.turned_left_rad() <= seen.turned_right_rad();
  const DriveAdvice turn = left_next ? DriveAdvice::turn_left : DriveAdvice::turn_right;
  const double less = std::min(seen.turned_left_rad(), seen.turned_right_rad());
  const double travel = seen.wheel_travel_rad() / needs.wheel_travel_rad;
  if (less < needs.turn_each_way_rad && less / needs.turn_each_way_rad <= travel) { return turn; }
  if (travel < 1.0) { return DriveAdvice::drive_straight; }
  // Long straights hide the turns that were driven: neither is to outweigh the other.
  constexpr double kMostlyStraight = 0.9;
  if (less < needs.turn_each_way_rad || seen.arc_spread() < needs.min_arc_spread ||
      seen.speed_share() > kMostlyStraight) {
    return turn;
  }
  std::size_t least = 1;
  for (std::size_t k = 2; k <= static_cast<std::size_t>(Parameter::time_offset); ++k) {
    if (percent_[k] < percent_[least]) { least = k; }
  }
  const auto parameter = static_cast<Parameter>(least);
  if (parameter == Parameter::time_offset) { return DriveAdvice::change_speed; }
  const bool by_turning = parameter == Parameter::track_width || parameter == Parameter::lidar_x ||
                          parameter == Parameter::lidar_y;
  return by_turning ? turn : DriveAdvice::drive_straight;
}

/// Everything once more and from all of the data, so that refusal and progress tell the same; a
/// piece in each slice.
void CalibrationRoutine::check() {
  bool done = true;
  switch (piece_) {
    case 0: done = solved_joint(); break;
    case 1: done = solved(lidar_clock_.core(), offset_report_); break;
    case 2: done = solved(gyro_clock_.core(), gyro_offset_report_); break;
    case 3: static_cast<void>(gyro_.solve(gyro_report_)); break;
    case 4: look_at_progress(); break;
    default: judge_all(); return;
  }
  if (done) { ++piece_; }
}

void CalibrationRoutine::judge_all() {
  piece_ = 0;
  if (report_.refusal) {
    refuse(report_.refusal);
  } else if (offset_report_.refusal) {
    refuse(offset_report_.refusal);
  } else if (magnitude(offset_report_.offset_s.value - used_offset_s_) >
             std::max(config_.max_offset_change_s, 4.0 * offset_report_.offset_s.std)) {
    // The clocks became known only now, and the rest was collected with wrong ones.
    refuse({RefusalReason::too_little_data, Parameter::time_offset});
  } else if (config_.use_gyro && gyro_heard_ && gyro_report_.scale_refusal) {
    refuse(gyro_report_.scale_refusal);
  } else {
    phase_ = CalibrationPhase::solving;
  }
}

}  // namespace picolo::inline v0
