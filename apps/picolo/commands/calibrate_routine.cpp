// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/controller/calibration_routine.hpp"
#include "picolo/controller/scan_odometer.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kPoints = 1024;
constexpr double kCountsPerRadian = 1e6;  // of the counters that the log's angles are made into
constexpr double kWaitForTheEnd_s = 120.0;

Timestamp at(double stamp_s) {
  return Timestamp{from_seconds(stamp_s)};
}

/// The log's records in the order of their stamps, into the routine as a controller feeds it.
class Player {
 public:
  Player(const DriveFile& drive, bool tell)
      : drive_{drive},
        tell_{tell},
        routine_{{.counts_per_revolution = 2.0 * std::numbers::pi * kCountsPerRadian,
                  .use_gyro = drive.gyro.size() >= 2}} {}

  void play(double collect_share) {
    const double begin_s = first_stamp();
    const double finish_s = begin_s + collect_share * (last_stamp() - begin_s);
    static_cast<void>(routine_.start(at(begin_s)));
    while (next_record()) {
      if (now_s_ >= finish_s) { static_cast<void>(routine_.finish()); }
      work();
    }
    static_cast<void>(routine_.finish());
    const double end_s = now_s_ + kWaitForTheEnd_s;
    for (; routine_.running() && now_s_ < end_s; now_s_ += 0.01) { work(); }
  }

  [[nodiscard]] const CalibrationRoutine& routine() const { return routine_; }
  [[nodiscard]] const ScanOdometerCounters& scans() const { return odometer_.core().counters(); }
  /// Every displacement, with the wheels at the found clock.
  [[nodiscard]] std::vector<MotionSample> samples() const {
    std::vector<MotionSample> samples;
    const double age_s = routine_.offset_report().offset_s.value;
    for (const ScanDisplacement& scan : seen_) {
      const double begin_s = to_seconds_f64(scan.begin.time_since_epoch());
      const double end_s = to_seconds_f64(scan.end.time_since_epoch());
      const WheelAngles a = wheels_at(drive_.wheels, begin_s - age_s);
      const WheelAngles b = wheels_at(drive_.wheels, end_s - age_s);
      const double duration_s = end_s - begin_s;
      samples.push_back({duration_s, (b.left_rad - a.left_rad) / duration_s,
                         (b.right_rad - a.right_rad) / duration_s, scan.motion});
    }
    return samples;
  }

 private:
  template <typename Record>
  [[nodiscard]] static double stamp_of(const std::vector<Record>& records, std::size_t k) {
    return k < records.size() ? records[k].stamp_s : static_cast<double>(INFINITY);
  }
  [[nodiscard]] double first_stamp() const {
    return std::min(
        {stamp_of(drive_.wheels, 0), stamp_of(drive_.scans, 0), stamp_of(drive_.gyro, 0)});
  }
  [[nodiscard]] double last_stamp() const {
    return std::max(drive_.wheels.back().stamp_s, drive_.scans.back().stamp_s);
  }

  bool next_record() {
    const double wheels_s = stamp_of(drive_.wheels, wheel_);
    const double scan_s = stamp_of(drive_.scans, scan_);
    const double gyro_s = stamp_of(drive_.gyro, gyro_);
    const double next_s = std::min({wheels_s, scan_s, gyro_s});
    if (!std::isfinite(next_s)) { return false; }
    now_s_ = std::max(now_s_, next_s);
    if (wheels_s == next_s) {
      add_wheels(drive_.wheels[wheel_++]);
    } else if (gyro_s == next_s) {
      ImuSample sample{.stamp = at(gyro_s)};
      sample.rate_radps[2] = static_cast<float>(drive_.gyro[gyro_++].rate_radps);
      routine_.add(sample);
    } else {
      add_scan(drive_.scans[scan_++]);
    }
    return true;
  }

  void add_wheels(const WheelAngles& angles) {
    WheelTicks ticks{.stamp = at(angles.stamp_s)};
    ticks.ticks[0] = std::llround(angles.left_rad * kCountsPerRadian);
    ticks.ticks[1] = std::llround(angles.right_rad * kCountsPerRadian);
    routine_.add(ticks);
  }

  void add_scan(const PointScan& scan) {
    if (!routine_.listening()) { return; }
    odometer_.core().offer({scan.x_m, scan.y_m}, at(scan.stamp_s), scan.odom_T_base, {});
  }

  void work() {
    while (odometer_.core().step()) {}
    ScanDisplacement displacement;
    if (odometer_.core().take(displacement)) {
      routine_.add_scan(displacement.begin, displacement.end, displacement.motion);
      seen_.push_back(displacement);
    }
    while (routine_.step(at(now_s_))) {}
    if (!tell_ || (routine_.phase() == told_phase_ && routine_.advice() == told_advice_)) {
      return;
    }
    told_phase_ = routine_.phase();
    told_advice_ = routine_.advice();
    fmt::print("{:8.1f} s  {:10} {}\n", now_s_ - first_stamp(), to_string(told_phase_),
               to_string(told_advice_));
  }

  const DriveFile& drive_;
  bool tell_;
  CalibrationRoutine routine_;
  ScanOdometer<kPoints> odometer_;
  std::vector<ScanDisplacement> seen_;
  std::size_t wheel_ = 0;
  std::size_t scan_ = 0;
  std::size_t gyro_ = 0;
  double now_s_ = 0.0;
  CalibrationPhase told_phase_ = CalibrationPhase::idle;
  DriveAdvice told_advice_ = DriveAdvice::none;
};

constexpr Parameter kShown[] = {Parameter::wheel_radius_left, Parameter::wheel_radius_right,
                                Parameter::track_width,       Parameter::lidar_x,
                                Parameter::lidar_y,           Parameter::lidar_yaw,
                                Parameter::time_offset,       Parameter::gyro_bias,
                                Parameter::gyro_scale,        Parameter::gyro_offset};

host::Json routine_json(const Player& player, bool gyro) {
  const CalibrationRoutine& routine = player.routine();
  host::Json json = joint_json(routine.report());
  json.erase("inlier_covariance");
  json.erase("condition");
  json["time_offset"] = to_json(routine.offset_report().offset_s);
  if (gyro) {
    json["gyro_bias"] = to_json(routine.gyro_report().bias_radps);
    json["gyro_scale"] = to_json(routine.gyro_report().scale);
    json["gyro_offset"] = to_json(routine.gyro_offset_report().offset_s);
  }
  json["phase"] = to_string(routine.phase());
  json["scans_matched"] = player.scans().matched;
  json["scans_not_matched"] = player.scans().failed;
  json["percent"] = host::Json::object();
  json["lacks"] = host::Json::object();
  for (const Parameter parameter : kShown) {
    json["percent"][to_string(parameter)] = routine.percent(parameter);
    if (routine.percent(parameter) < 100) {
      json["lacks"][to_string(parameter)] = to_string(routine.lacks(parameter));
    }
  }
  json["refused"] = to_json(routine.refusal());
  return json;
}

}  // namespace

ExitCode calibrate_routine_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const DriveFile drive = read_drive(options.file, options.ticks_per_turn, diagnostics);
  if (drive.wheels.size() < 2 || drive.scans.size() < 2) {
    throw host::UserError{ExitCode::input, drive.name, "needs wheel counters and scans",
                          "give a log with TICKS or ENC lines and scans"};
  }
  const auto player = std::make_unique<Player>(drive, !options.common.json);
  player->play(options.collect_share);
  const CalibrationRoutine& routine = player->routine();
  draw_joint(player->samples(), routine.report().drive, "Routine", options.common.out);
  print_calibration(routine_json(*player, drive.gyro.size() >= 2), options.common.json,
                    options.common.out);
  return end_of_calibration(routine.refusal(), drive.name, drive.damage);
}

}  // namespace picolo::tool
