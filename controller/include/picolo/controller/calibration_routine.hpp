// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Calibration while the vehicle drives: wait for standstill, collect, check, solve, verify on
/// fresh data, store; in slices, with what is still missing and what to drive next.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/calibration/gyro_calibration.hpp"
#include "picolo/calibration/imu_mount.hpp"
#include "picolo/calibration/joint_streaming.hpp"
#include "picolo/calibration/record.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/controller/angle_history.hpp"
#include "picolo/controller/calibration_store.hpp"
#include "picolo/controller/can_table_names.hpp"
#include "picolo/core/time.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

[[nodiscard]] const char* to_string(CalibrationPhase phase);
/// One sentence for the person who drives.
[[nodiscard]] const char* to_string(DriveAdvice advice);

/// Parameters by their number; 0 (none) is not used.
inline constexpr std::size_t kCalibrationParameters = 13;

struct CalibrationRoutineConfig {
  double counts_per_revolution = 4096.0;
  /// Calibrate it too, when one is heard. Without, there is no need to stand first.
  bool use_gyro = true;
  double gyro_sign = 1.0;
  double initial_time_offset_s = 0.0;
  /// Taken out of the scans' stamps already; what is found comes on top of it.
  double known_lidar_age_s = 0.0;
  JointStreamingConfig joint{};  ///< what is refused when it is all there is
  TimeOffsetConfig time_offset{.max_offset_s = 0.3};
  TimeOffsetConfig gyro_offset{.max_offset_s = 0.15, .parameter = Parameter::gyro_offset};
  GyroCalibrationConfig gyro{};
  // Collecting ends by itself when every standard deviation is below these: two of them are 0.1 %,
  // 2 mm, 0.1 deg.
  double target_relative_std = 0.0005;  ///< of radii and track width
  double target_position_std_m = 0.001;
  double target_yaw_std_rad = 0.00085;
  double target_offset_std_s = 0.001;
  double target_scale_std = 0.003;
  Duration stand = 2s;      ///< at standstill, for the gyro's bias
  Duration max_wait = 60s;  ///< for standstill; and for fresh data at the end
  Duration max_collect = 10min;
  std::uint32_t verify_samples = 40;   ///< in which the vehicle moves
  double min_verified_share = 0.8;     ///< of them within the gates of `joint`
  double max_offset_change_s = 0.003;  ///< beyond it collecting starts again, at most four times
  std::size_t lags_per_step = 6;
  std::size_t fits_per_step = 4;  ///< of a clock, when its offset is looked at
  std::size_t granules_per_step = 2;
  [[nodiscard]] constexpr bool valid() const {
    return counts_per_revolution > 0.0 && (gyro_sign == 1.0 || gyro_sign == -1.0) &&
           joint.valid() && time_offset.valid() && gyro_offset.valid() && gyro.valid() &&
           target_relative_std > 0.0 && target_position_std_m > 0.0 && target_yaw_std_rad > 0.0 &&
           target_offset_std_s > 0.0 && target_scale_std > 0.0 && stand > Duration{0} &&
           max_wait > stand && max_collect > Duration{0} && verify_samples > 0 &&
           min_verified_share > 0.0 && min_verified_share <= 1.0 && max_offset_change_s > 0.0 &&
           lags_per_step > 0 && fits_per_step > 0 && granules_per_step > 0;
  }
};

/// Listens to the same samples as the pose estimate and touches nothing of it: what it finds is in
/// `record` and, with a store, in the store; it counts from the next start on. A run that is
/// refused or aborted leaves the store as it was. State: about 26 KiB whatever the length of the
/// drive.
/// Cost: `add` O(1); a `step` at most some 2500 floating-point operations in double. Context: cycle
/// only.
class CalibrationRoutine {
 public:
  /// `store` may be null: nothing is stored then. It outlives the routine. A configuration that is
  /// not valid gives way to the default.
  explicit CalibrationRoutine(const CalibrationRoutineConfig& config,
                              CalibrationStore* store = nullptr);

  /// `full`: a run is under way.
  Status start(Timestamp now);
  /// The driver says that this is all: checks what there is. `not_ready`: not collecting.
  Status finish();
  /// `not_ready`: none is under way, or it is in the middle of storing.
  Status cancel();

  void add(const WheelTicks& ticks);
  void add(const ImuSample& sample);
  /// Motion of the lidar in its own frame between two scans, stamps as the lidar gave them.
  void add_scan(Timestamp begin, Timestamp end, const Pose2d& lidar_motion);

  /// One slice of work. False when there is nothing to do now.
  bool step(Timestamp now);

  [[nodiscard]] CalibrationPhase phase() const { return phase_; }
  [[nodiscard]] bool running() const {
    return phase_ != CalibrationPhase::idle && phase_ != CalibrationPhase::done &&
           phase_ != CalibrationPhase::refused && phase_ != CalibrationPhase::aborted;
  }
  /// Scans are of use now.
  [[nodiscard]] bool listening() const {
    return phase_ == CalibrationPhase::collecting || phase_ == CalibrationPhase::verifying;
  }
  /// Set while refused: the most basic thing that was missing.
  [[nodiscard]] const Refusal& refusal() const { return refusal_; }
  /// What each parameter by itself lacks, as of the last look at the data (once a second).
  [[nodiscard]] RefusalReason lacks(Parameter parameter) const {
    return lacks_[static_cast<std::size_t>(parameter) % kCalibrationParameters];
  }
  /// 0 to 100: information gathered against what is needed, as of the last look.
  [[nodiscard]] std::uint8_t percent(Parameter parameter) const {
    return percent_[static_cast<std::size_t>(parameter) % kCalibrationParameters];
  }
  [[nodiscard]] DriveAdvice advice() const { return advice_; }
  /// Complete once the phase is done.
  [[nodiscard]] const CalibrationRecord& record() const { return record_; }
  [[nodiscard]] const JointReport& report() const { return report_; }
  [[nodiscard]] const TimeOffsetReport& offset_report() const { return offset_report_; }
  [[nodiscard]] const TimeOffsetReport& gyro_offset_report() const { return gyro_offset_report_; }
  [[nodiscard]] const GyroReport& gyro_report() const { return gyro_report_; }
  /// Of the IMU; told, but a calibration is complete without it.
  [[nodiscard]] const ImuMountReport& mount_report() const { return mount_report_; }
  [[nodiscard]] bool gyro_heard() const { return gyro_heard_; }
  [[nodiscard]] Duration elapsed(Timestamp now) const { return now - origin_; }
  [[nodiscard]] std::uint32_t scans() const { return scans_; }
  /// Scans that the wheels' history no longer reached, or that came faster than they were used.
  [[nodiscard]] std::uint32_t scans_dropped() const { return scans_dropped_; }

 private:
  struct Scan {
    double begin_s = 0.0;
    double end_s = 0.0;
    Pose2d motion{};
  };
  /// Sums of accelerations felt in a quarter of a second.
  struct FeltWindow {
    double begin_s = 0.0;
    double end_s = 0.0;
    double x_mps2 = 0.0;
    double y_mps2 = 0.0;
    double samples = 0.0;
  };
  /// A scan that was taken, and what is still to be done with it, a slice each.
  struct TakenScan {
    enum class Part : std::uint8_t { none, sample, turn };
    Part next = Part::none;
    Scan scan{};
    MotionSample sample{};
  };
  struct BaseSpeed {
    double forward_mps = 0.0;
    double omega_radps = 0.0;
  };
  static constexpr std::size_t kWaitingScans = 8;
  static constexpr std::size_t kIndexes = kCalibrationParameters;

  [[nodiscard]] double seconds(Timestamp stamp) const { return to_seconds_f64(stamp - origin_); }
  void enter(CalibrationPhase phase, Timestamp now);
  void refuse(const Refusal& refusal);
  bool work();
  [[nodiscard]] bool waits_for_gyro(const Scan& scan) const;
  [[nodiscard]] bool take_scan();
  void use_taken();
  void take_out_bends(const Scan& scan, MotionSample& sample) const;
  void use(const MotionSample& sample);
  void learn_gyro(const Scan& scan);
  void feel(double stamp_s, const ImuSample& sample);
  bool use_felt();
  [[nodiscard]] bool speed_at(double stamp_s, BaseSpeed& speed) const;
  void wait_for_standstill(Timestamp now);
  bool collect(Timestamp now);
  void look(Timestamp now);
  [[nodiscard]] bool solved(TimeOffsetCore& clock, TimeOffsetReport& report);
  [[nodiscard]] bool solved_joint();
  [[nodiscard]] bool looked_at_gyro();
  void follow_offset();
  void look_at_progress();
  void set(Parameter parameter, double share, RefusalReason reason);
  [[nodiscard]] double information(std::size_t index, double target) const;
  [[nodiscard]] RefusalReason wheels_lack(const Refusal& judged, std::size_t index) const;
  [[nodiscard]] DriveAdvice choose_advice() const;
  [[nodiscard]] bool complete() const;
  void check();
  void judge_all();
  void solve(Timestamp now);
  void verify(const MotionSample& sample);
  void judge_verification(Timestamp now);
  void store(Timestamp now);

  CalibrationRoutineConfig config_;
  CalibrationStore* store_;
  JointStreaming joint_;
  TimeOffset<41, 192, 8> lidar_clock_;
  TimeOffset<31, 128, 8> gyro_clock_;
  GyroCalibration gyro_;
  AngleHistory<160> gyro_angle_;
  JointReport report_{};
  TimeOffsetReport offset_report_{};
  TimeOffsetReport gyro_offset_report_{};
  GyroReport gyro_report_{};
  ImuMountCalibration mount_;
  ImuMountReport mount_report_{};
  FeltWindow felt_{};
  FeltWindow felt_before_{};
  FeltWindow felt_due_{};
  CalibrationRecord record_{};
  std::array<Scan, kWaitingScans> waiting_{};
  TakenScan taken_{};
  std::size_t first_ = 0;
  std::size_t held_ = 0;
  std::array<std::uint8_t, kIndexes> percent_{};
  std::array<RefusalReason, kIndexes> lacks_{};
  CalibrationPhase phase_ = CalibrationPhase::idle;
  DriveAdvice advice_ = DriveAdvice::none;
  Refusal refusal_{};
  Timestamp origin_{};
  Timestamp entered_{};
  Timestamp next_look_{};
  int look_ = 0;
  int piece_ = 0;    // of a look or of the check, in slices
  int solving_ = 0;  // within a piece
  bool finishing_ = false;
  int restarts_ = 0;
  double used_offset_s_ = 0.0;
  // wheels
  bool has_ticks_ = false;
  std::array<std::int64_t, 2> last_ticks_{};
  std::array<double, 2> angle_rad_{};
  Timestamp moved_{};
  // gyro
  bool gyro_heard_ = false;
  double gyro_block_begin_s_ = 0.0;
  double gyro_block_rad_ = 0.0;
  // verification
  std::uint32_t verified_ = 0;
  std::uint32_t within_ = 0;
  Pose2d error_sum_{};
  std::uint32_t scans_ = 0;
  std::uint32_t scans_dropped_ = 0;
  bool saving_ = false;
};

}  // namespace picolo::inline v0
