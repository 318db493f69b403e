// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/calibration_routine.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr Duration kQuiet = 500ms;  // without a count: the vehicle stands
constexpr double kGyroBlock_s = 0.1;
constexpr Duration kLook = 250ms;  // a quarter of the looks each, all of them once a second

}  // namespace

CalibrationRoutine::CalibrationRoutine(const CalibrationRoutineConfig& config,
                                       CalibrationStore* store)
    : config_(config.valid() ? config : CalibrationRoutineConfig{}),
      store_(store),
      joint_(config_.joint),
      lidar_clock_(config_.time_offset),
      gyro_clock_(config_.gyro_offset),
      gyro_(config_.gyro) {}

Status CalibrationRoutine::start(Timestamp now) {
  if (running()) { return Status::full; }
  joint_.reset();
  lidar_clock_.core().reset();
  gyro_clock_.core().reset();
  gyro_.reset();
  gyro_angle_.core().reset();
  report_ = {};
  offset_report_ = {};
  gyro_offset_report_ = {};
  gyro_report_ = {};
  mount_.reset();
  mount_report_ = {};
  felt_ = {};
  felt_before_ = {};
  felt_due_ = {};
  record_ = {};
  held_ = 0;
  percent_.fill(0);
  lacks_.fill(RefusalReason::too_little_data);
  refusal_ = {};
  origin_ = now;
  next_look_ = now;
  look_ = 0;
  piece_ = 0;
  solving_ = 0;
  taken_ = {};
  finishing_ = false;
  restarts_ = 0;
  used_offset_s_ = config_.initial_time_offset_s;
  has_ticks_ = false;
  angle_rad_ = {};
  moved_ = now;
  gyro_heard_ = false;
  verified_ = 0;
  within_ = 0;
  error_sum_ = {};
  scans_ = 0;
  scans_dropped_ = 0;
  saving_ = false;
  enter(CalibrationPhase::standstill, now);
  advice_ = DriveAdvice::stand_still;
  return Status::ok;
}

Status CalibrationRoutine::finish() {
  if (phase_ != CalibrationPhase::collecting) { return Status::not_ready; }
  finishing_ = true;
  return Status::ok;
}

Status CalibrationRoutine::cancel() {
  if (!running() || saving_) { return Status::not_ready; }
  refuse({RefusalReason::aborted, Parameter::none});
  phase_ = CalibrationPhase::aborted;
  return Status::ok;
}

void CalibrationRoutine::enter(CalibrationPhase phase, Timestamp now) {
  phase_ = phase;
  entered_ = now;
}

void CalibrationRoutine::refuse(const Refusal& refusal) {
  refusal_ = refusal;
  phase_ = CalibrationPhase::refused;
  advice_ = DriveAdvice::none;
}

void CalibrationRoutine::add(const WheelTicks& ticks) {
  if (!running()) { return; }
  const std::array<std::int64_t, 2> counts{ticks.ticks[0], ticks.ticks[1]};
  if (has_ticks_ && !ticks.restarted) {
    const double scale = 2.0 * std::numbers::pi / config_.counts_per_revolution;
    for (std::size_t k = 0; k < 2; ++k) {
      angle_rad_[k] += scale * static_cast<double>(counts[k] - last_ticks_[k]);
    }
    if (counts != last_ticks_) { moved_ = ticks.stamp; }
  }
  has_ticks_ = true;
  last_ticks_ = counts;
  const WheelAngles angles{seconds(ticks.stamp), angle_rad_[0], angle_rad_[1]};
  // Not newer than the last: left out, as the pose estimate does.
  static_cast<void>(lidar_clock_.core().offer_wheels(angles));
  if (config_.use_gyro) { static_cast<void>(gyro_clock_.core().offer_wheels(angles)); }
}

void CalibrationRoutine::add(const ImuSample& sample) {
  if (!running() || !config_.use_gyro || sample.saturated) { return; }
  const double stamp_s = seconds(sample.stamp);
  const double rate = config_.gyro_sign * static_cast<double>(sample.rate_radps[2]);
  if (phase_ == CalibrationPhase::standstill && has_ticks_ && sample.stamp - moved_ > kQuiet) {
    gyro_.add_standing(rate);
  }
  gyro_angle_.core().add(stamp_s, rate);
  feel(stamp_s, sample);
  const Result<double> angle = gyro_angle_.core().at(stamp_s);
  if (!angle) { return; }
  if (!gyro_heard_) {
    gyro_heard_ = true;
    gyro_block_begin_s_ = stamp_s;
    gyro_block_rad_ = *angle;
  }
  if (stamp_s - gyro_block_begin_s_ < kGyroBlock_s) { return; }
  if (listening()) {
    static_cast<void>(
        gyro_clock_.core().offer_rotation(gyro_block_begin_s_, stamp_s, *angle - gyro_block_rad_));
  }
  gyro_block_begin_s_ = stamp_s;
  gyro_block_rad_ = *angle;
}

void CalibrationRoutine::add_scan(Timestamp begin, Timestamp end, const Pose2d& lidar_motion) {
  if (!listening()) { return; }
  ++scans_;
  const Scan scan{seconds(begin), seconds(end), lidar_motion};
  if (held_ == kWaitingScans) {
    ++scans_dropped_;
    return;
  }
  waiting_[(first_ + held_) % kWaitingScans] = scan;
  ++held_;
  if (phase_ == CalibrationPhase::collecting) {
    static_cast<void>(
        lidar_clock_.core().offer_rotation(scan.begin_s, scan.end_s, lidar_motion.theta_rad));
  }
}

/// One slice of what the samples ask for; false when nothing is due.
bool CalibrationRoutine::work() {
  return use_felt() || joint_.step() || lidar_clock_.core().step(config_.lags_per_step) ||
         gyro_clock_.core().step(config_.lags_per_step) || take_scan();
}

/// The gyro speaks, but has not come to the end of the scan yet.
bool CalibrationRoutine::waits_for_gyro(const Scan& scan) const {
  constexpr double kPatience_s = 0.3;
  if (!gyro_heard_ || phase_ != CalibrationPhase::collecting) { return false; }
  const double end_s = scan.end_s + gyro_offset_report_.offset_s.value - used_offset_s_;
  if (gyro_angle_.core().at(end_s).status() != Status::not_ready) { return false; }
  WheelAngles later;
  return lidar_clock_.core().wheels_at(scan.end_s + kPatience_s, later) == Status::not_ready;
}

/// A slice; false when no scan can be used.
bool CalibrationRoutine::take_scan() {
  if (taken_.next != TakenScan::Part::none) {
    use_taken();
    return true;
  }
  if (held_ == 0) { return false; }
  const Scan scan = waiting_[first_];
  WheelAngles begin;
  WheelAngles end;
  // The wheels as they stood when the lidar saw, not when it said so.
  const TimeOffsetCore& wheels = lidar_clock_.core();
  const Status status = wheels.wheels_at(scan.end_s - used_offset_s_, end);
  if (status == Status::not_ready || waits_for_gyro(scan)) { return false; }
  first_ = (first_ + 1) % kWaitingScans;
  --held_;
  const double duration_s = scan.end_s - scan.begin_s;
  if (!is_ok(status) || !is_ok(wheels.wheels_at(scan.begin_s - used_offset_s_, begin)) ||
      !(duration_s > 0.0)) {
    ++scans_dropped_;
    return true;
  }
  MotionSample sample{duration_s, (end.left_rad - begin.left_rad) / duration_s,
                      (end.right_rad - begin.right_rad) / duration_s, scan.motion};
  take_out_bends(scan, sample);
  taken_ = {TakenScan::Part::sample, scan, sample};
  return true;
}

void CalibrationRoutine::use_taken() {
  if (taken_.next == TakenScan::Part::sample) {
    taken_.next = TakenScan::Part::turn;
    use(taken_.sample);
    return;
  }
  taken_.next = TakenScan::Part::none;
  learn_gyro(taken_.scan);
}

/// The estimator takes the wheels' rates for constant between two scans. While they change, the way
/// bends otherwise than an arc by tenths of a millimetre, always to the same side where starts and
/// stops differ; what is known of the vehicle so far is good enough to take that out.
void CalibrationRoutine::take_out_bends(const Scan& scan, MotionSample& sample) const {
  constexpr int kPieces = 4;
  const DriveParameters& drive = report_.drive;
  const double tenth_m = 0.1 * drive.track_m;
  const double variance = report_.covariance[14];
  const bool known = drive.radius_left_m > 0.0 && drive.radius_right_m > 0.0 && tenth_m > 0.0 &&
                     variance > 0.0 && variance < tenth_m * tenth_m;
  if (!known) { return; }
  const double piece_s = sample.duration_s / kPieces;
  Pose2d way;
  WheelAngles last;
  if (!is_ok(lidar_clock_.core().wheels_at(scan.begin_s - used_offset_s_, last))) { return; }
  for (int k = 1; k <= kPieces; ++k) {
    const double stamp_s = scan.begin_s + piece_s * k - used_offset_s_;
    WheelAngles now;
    if (!is_ok(lidar_clock_.core().wheels_at(stamp_s, now))) { return; }
    way = way * base_motion(
                    drive, {1.0, now.left_rad - last.left_rad, now.right_rad - last.right_rad, {}});
    last = now;
  }
  const Pose2d arc = base_motion(drive, sample);
  const SinCos<double> yaw = sin_cos(drive.base_T_lidar.theta_rad);
  const double x = way.x_m - arc.x_m;
  const double y = way.y_m - arc.y_m;
  sample.lidar_motion.x_m -= yaw.cosine * x + yaw.sine * y;
  sample.lidar_motion.y_m -= yaw.cosine * y - yaw.sine * x;
}

void CalibrationRoutine::use(const MotionSample& sample) {
  if (phase_ == CalibrationPhase::verifying) {
    verify(sample);
    return;
  }
  // A few samples at rest show that it rests; more would only make the noise look small.
  constexpr std::uint64_t kRestingSamples = 64;
  constexpr double kResting_rad = 1e-3;
  const double rolled_rad =
      sample.duration_s * (magnitude(sample.left_radps) + magnitude(sample.right_radps));
  const Pose2d& seen = sample.lidar_motion;
  const bool rests = rolled_rad < kResting_rad && magnitude(seen.theta_rad) < 0.02 &&
                     hypotenuse(seen.x_m, seen.y_m) < 0.02;
  if (rests && joint_.samples() >= kRestingSamples) { return; }
  if (!is_ok(joint_.offer(sample))) { ++scans_dropped_; }
}

void CalibrationRoutine::learn_gyro(const Scan& scan) {
  if (!config_.use_gyro || phase_ != CalibrationPhase::collecting) { return; }
  const double shift_s = gyro_offset_report_.offset_s.value - used_offset_s_;
  const Result<double> begin = gyro_angle_.core().at(scan.begin_s + shift_s);
  const Result<double> end = gyro_angle_.core().at(scan.end_s + shift_s);
  if (!begin || !end) { return; }
  static_cast<void>(
      gyro_.add_turn(*end - *begin, scan.end_s - scan.begin_s, scan.motion.theta_rad));
}

bool CalibrationRoutine::step(Timestamp now) {
  switch (phase_) {
    case CalibrationPhase::standstill: wait_for_standstill(now); return false;
    case CalibrationPhase::collecting: return collect(now);
    case CalibrationPhase::checking: check(); return true;
    case CalibrationPhase::solving: solve(now); return true;
    case CalibrationPhase::verifying:
      if (take_scan()) { return true; }
      judge_verification(now);
      return false;
    case CalibrationPhase::saving: store(now); return true;
    case CalibrationPhase::idle:
    case CalibrationPhase::done:
    case CalibrationPhase::aborted:
    case CalibrationPhase::refused: break;
  }
  return false;
}

void CalibrationRoutine::wait_for_standstill(Timestamp now) {
  const bool stood = has_ticks_ && (!config_.use_gyro || now - moved_ > kQuiet + config_.stand);
  static_cast<void>(gyro_.solve(gyro_report_));
  const bool bias_known = !config_.use_gyro || !gyro_heard_ || !gyro_report_.bias_refusal;
  if (stood && bias_known) {
    advice_ = DriveAdvice::turn_left;
    next_look_ = now + kLook;
    enter(CalibrationPhase::collecting, now);
    return;
  }
  if (now - entered_ <= config_.max_wait) { return; }
  if (!has_ticks_) {
    refuse({RefusalReason::encoder_disconnected, Parameter::wheel_radius_left});
  } else {
    refuse({stood ? gyro_report_.bias_refusal.reason : RefusalReason::too_little_data,
            Parameter::gyro_bias});
  }
}

bool CalibrationRoutine::collect(Timestamp now) {
  if (piece_ > 0 || solving_ > 0) {
    look(now);
    return true;
  }
  if (work()) { return true; }
  const bool out_of_time = now - entered_ > config_.max_collect;
  if (finishing_ || out_of_time || complete()) {
    advice_ = DriveAdvice::none;
    enter(CalibrationPhase::checking, now);
    return true;
  }
  if (now < next_look_) { return false; }
  next_look_ += kLook;
  look_ = (look_ + 1) % 4;
  look(now);
  return true;
}

void CalibrationRoutine::solve(Timestamp now) {
  record_.drive = report_.drive;
  for (std::size_t k = 0; k < 6; ++k) {
    record_.drive_std[k] = square_root(std::max(0.0, report_.covariance[7 * k]));
  }
  record_.time_offset_s = config_.known_lidar_age_s + offset_report_.offset_s.value;
  record_.gyro_bias_radps = gyro_report_.bias_radps.value;
  record_.gyro_scale = gyro_report_.scale_refusal ? 1.0 : gyro_report_.scale.value;
  record_.gyro_offset_s = gyro_offset_report_.refusal ? 0.0 : gyro_offset_report_.offset_s.value;
  record_.calibrated = true;
  advice_ = DriveAdvice::drive_on;
  held_ = 0;  // what waits was seen before the solution
  enter(CalibrationPhase::verifying, now);
}

void CalibrationRoutine::store(Timestamp now) {
  if (store_ == nullptr) {
    enter(CalibrationPhase::done, now);
    return;
  }
  Status status = Status::ok;
  if (saving_) {
    status = store_->step(config_.granules_per_step);
  } else {
    status = store_->begin_save(record_);
    saving_ = is_ok(status);
    if (saving_) { return; }
  }
  if (status == Status::not_ready) { return; }
  saving_ = false;
  if (is_ok(status)) {
    enter(CalibrationPhase::done, now);
  } else {
    refuse({RefusalReason::not_stored, Parameter::none});
  }
}

}  // namespace picolo::inline v0
