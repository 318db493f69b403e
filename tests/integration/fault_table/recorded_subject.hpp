// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recorded log as a live drive at its own times: wheel counts as its odometry says a
/// differential drive would have counted, scans when they were taken. No log with a lidar has an
/// IMU: there is none, or its gyro is the heading of a trajectory.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "faulty_devices.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/core/random.hpp"
#include "picolo/host/carmen.hpp"
#include "picolo/host/trajectory.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_watchdog.hpp"
#include "subject.hpp"

namespace picolo::test {

inline constexpr double kLogTrack_m = 0.5;
inline constexpr double kLogMetresPerCount = 1.5e-4;  // as the simulated vehicle

/// Numbers over time that do not change their rate at once: cubic between knots, with the mean rate
/// about each of them; constant before the first and after the last.
template <std::size_t N>
class Curve {
 public:
  using Values = std::array<double, N>;
  void add(Timestamp stamp, const Values& values) { knots_.push_back({stamp, values}); }
  [[nodiscard]] bool empty() const { return knots_.empty(); }
  [[nodiscard]] Timestamp end() const { return knots_.back().stamp; }
  [[nodiscard]] Values at(Timestamp stamp) const {
    const auto next =
        std::upper_bound(knots_.begin(), knots_.end(), stamp,
                         [](Timestamp at, const Knot& knot) { return at < knot.stamp; });
    if (next == knots_.begin()) { return next->values; }
    const Knot& before = *(next - 1);
    if (next == knots_.end()) { return before.values; }
    const Values from = rate(next - 1);
    const Values to = rate(next);
    const double length_s = std::max(1e-6, to_seconds_f64(next->stamp - before.stamp));
    const double u = to_seconds_f64(stamp - before.stamp) / length_s;
    Values values{};
    for (std::size_t i = 0; i < N; ++i) {
      const double way = next->values[i] - before.values[i];
      values[i] = before.values[i] + u * u * (3.0 - 2.0 * u) * way +
                  u * (1.0 - u) * length_s * ((1.0 - u) * from[i] - u * to[i]);
    }
    return values;
  }

 private:
  struct Knot {
    Timestamp stamp{};
    Values values{};
  };
  [[nodiscard]] Values rate(std::vector<Knot>::const_iterator knot) const {
    const auto before = knot == knots_.begin() ? knot : knot - 1;
    const auto after = knot + 1 == knots_.end() ? knot : knot + 1;
    const double time_s = std::max(1e-6, to_seconds_f64(after->stamp - before->stamp));
    Values rate{};
    for (std::size_t i = 0; i < N; ++i) {
      rate[i] = (after->values[i] - before->values[i]) / time_s;
    }
    return rate;
  }

  std::vector<Knot> knots_;
};

/// The log on the clock of the replay, which begins a second before its first scan.
class LogTrack {
 public:
  explicit LogTrack(const host::CarmenLog& log) {
    if (log.scans.empty()) {
      read_sweeps(log);
    } else {
      read_scans(log);
    }
  }

  struct Scan {
    Timestamp stamp{};
    Timestamp received{};
    Duration beam_step{};
    std::vector<float> ranges_m;
    std::vector<float> bearings_rad;
    float no_return_m = 30.0F;  ///< from there on nothing came back
  };
  [[nodiscard]] const std::vector<Scan>& scans() const { return scans_; }
  [[nodiscard]] const Pose2d& base_T_lidar() const { return base_T_lidar_; }
  [[nodiscard]] Timestamp end() const { return rolled_.end(); }
  /// How far each wheel has rolled.
  [[nodiscard]] std::array<double, 2> metres_at(Timestamp stamp) const { return rolled_.at(stamp); }

  /// Whose headings, one for each scan of the log, are the gyro's.
  void take_gyro_from(const host::Trajectory& trajectory) {
    double heading = 0.0;
    for (std::size_t k = 0; k < std::min(trajectory.size(), scans_.size()); ++k) {
      const double theta = trajectory[k].pose.theta_rad;
      heading += std::remainder(theta - heading, 2.0 * std::numbers::pi);
      heading_.add(scans_[k].stamp, {heading});
    }
  }
  [[nodiscard]] bool has_gyro() const { return !heading_.empty(); }
  [[nodiscard]] double yaw_rate_at(Timestamp stamp) const {
    constexpr Duration kHalf = 5ms;
    const double turn = heading_.at(stamp + kHalf)[0] - heading_.at(stamp - kHalf)[0];
    return turn / to_seconds_f64(2 * kHalf);
  }

 private:
  /// As a differential drive would have counted the way to the next pose of the odometry.
  void drive_to(const Pose2d& odom_T_base, Timestamp stamp) {
    if (rolled_.empty()) { played_ = odom_T_base; }
    const Pose2d way = between(played_, odom_T_base);
    const double half = 0.5 * way.theta_rad;
    const double chord_m = way.x_m * std::cos(half) + way.y_m * std::sin(half);
    const double arc_m = std::abs(half) < 1e-9 ? chord_m : chord_m * half / std::sin(half);
    metres_[0] += arc_m - half * kLogTrack_m;
    metres_[1] += arc_m + half * kLogTrack_m;
    played_ = played_ * exp_se2(Tangent2<double>{arc_m, 0.0, way.theta_rad});
    rolled_.add(stamp, metres_);
  }
  void read_scans(const host::CarmenLog& log) {
    base_T_lidar_ = log.scans.front().base_T_lidar;
    for (const host::LogScan& scan : log.scans) {
      const Timestamp stamp{1s + from_seconds(scan.stamp_s - log.scans.front().stamp_s)};
      drive_to(scan.odom_T_base, stamp);
      const auto limit = static_cast<float>(std::min(30.0, scan.max_range_m.value_or(30.0)));
      scans_.push_back({stamp, stamp, Duration{0}, scan.ranges_m, scan.bearings_rad, limit});
    }
  }
  void read_sweeps(const host::CarmenLog& log) {
    base_T_lidar_ = {0.21, 0.0, std::numbers::pi};  // of the robot that recorded them
    for (const host::LogOdometry& odometry : log.odometry) {
      drive_to(odometry.odom_T_base, Timestamp{from_seconds(odometry.stamp_s)});
    }
    for (const host::LogSweep& sweep : log.sweeps) {
      scans_.push_back({Timestamp{from_seconds(sweep.stamp_s)},
                        Timestamp{from_seconds(sweep.received_s)},
                        from_seconds(sweep.time_increment_s), sweep.ranges_m, sweep.bearings_rad});
    }
  }

  Curve<2> rolled_;
  Curve<1> heading_;
  std::vector<Scan> scans_;
  Pose2d base_T_lidar_{};
  Pose2d played_{};
  std::array<double, 2> metres_{};
};

/// One frame for every sample of the wheels, which `LogWheels` fills.
class LogBus final : public CanBus {
 public:
  explicit LogBus(Clock& clock) : clock_(clock) {}
  Result<CanFrame> receive() override {
    if (next_ > clock_.now()) { return Status::not_ready; }
    const CanFrame frame{.stamp = next_, .id = kId};
    next_ += 10ms;
    return frame;
  }
  Status transmit(const CanFrame& /*frame*/) override { return Status::ok; }
  [[nodiscard]] CanStatus status() const override { return {}; }
  static constexpr std::uint32_t kId = 0x181;

 private:
  Clock& clock_;
  Timestamp next_{10ms};
};

class LogWheels {
 public:
  explicit LogWheels(const LogTrack& track) : track_(track) {}
  bool consume(const CanFrame& frame) {
    if (frame.id != LogBus::kId) { return false; }
    const std::array<double, 2> metres = track_.metres_at(frame.stamp);
    sample_ = WheelTicks{.stamp = frame.stamp};
    for (std::size_t i = 0; i < 2; ++i) {
      sample_.ticks[i] = std::llround(metres[i] / kLogMetresPerCount);
    }
    fresh_ = true;
    return true;
  }
  Result<WheelTicks> take() {
    if (!fresh_) { return Status::not_ready; }
    fresh_ = false;
    return sample_;
  }
  Status service(Timestamp /*now*/) { return Status::ok; }

 private:
  const LogTrack& track_;
  WheelTicks sample_{};
  bool fresh_ = false;
};

/// Every scan when it was received; then one empty reading, so that its end is seen at once.
class LogLidar {
 public:
  LogLidar(const LogTrack& track, Clock& clock) : track_(track), clock_(clock) {}
  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<RangeReading> readings) {
    std::size_t count = 0;
    while (count < readings.size() && scan_ < track_.scans().size() &&
           track_.scans()[scan_].received <= clock_.now()) {
      const LogTrack::Scan& scan = track_.scans()[scan_];
      RangeReading& reading = readings[count++];
      reading = {.stamp = scan.stamp + static_cast<std::int64_t>(beam_) * scan.beam_step,
                 .starts_sweep = beam_ == 0};
      if (beam_ == scan.ranges_m.size()) {
        reading.starts_sweep = true;
        ++scan_;
        beam_ = 0;
        continue;
      }
      reading.range_m = scan.ranges_m[beam_] < scan.no_return_m ? scan.ranges_m[beam_] : 0.0F;
      reading.bearing_rad = scan.bearings_rad[beam_];
      ++beam_;
    }
    if (count == 0) { return Status::not_ready; }
    return count;
  }

 private:
  const LogTrack& track_;
  Clock& clock_;
  std::size_t scan_ = 0;
  std::size_t beam_ = 0;
};

/// 100 samples a second of a vehicle that stands upright; noise of a cheap sensor.
class LogImu {
 public:
  LogImu(const LogTrack& track, Clock& clock) : track_(track), clock_(clock) {}
  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<ImuSample> samples) {
    if (!track_.has_gyro() || samples.empty() || next_ > clock_.now()) { return Status::not_ready; }
    ImuSample& sample = samples[0] = {.stamp = next_};
    for (std::size_t i = 0; i < 3; ++i) {
      sample.rate_radps[i] = static_cast<float>(0.002 * random_.gaussian());
      sample.acceleration_mps2[i] = static_cast<float>(0.05 * random_.gaussian());
    }
    sample.rate_radps[2] += static_cast<float>(track_.yaw_rate_at(next_));
    sample.acceleration_mps2[2] += 9.81F;
    next_ += 10ms;
    return std::size_t{1};
  }

 private:
  const LogTrack& track_;
  Clock& clock_;
  Random random_{7, 0};
  Timestamp next_{10ms};
};

class RecordedSubject final : public Subject {
 public:
  /// `scan_period`: of the log, for the limits of age. `lidar_age`: see ControllerConfig.
  RecordedSubject(const LogTrack& track, Duration scan_period, Duration lidar_age)
      : track_(track),
        wheels_driver_(track),
        lidar_driver_(track, clock_),
        imu_driver_(track, clock_),
        wheels_(wheels_driver_),
        lidar_(lidar_driver_, clock_),
        imu_(imu_driver_, clock_),
        controller_({bus_, clock_, cycles_, watchdog_}, wheels_, lidar_, imu_, events_,
                    config(track, scan_period, lidar_age)) {
    static_cast<void>(controller_.start());
  }

  void run_frame() override {
    clock_.set(controller_.next_frame());
    static_cast<void>(controller_.run_frame());
  }
  [[nodiscard]] Timestamp now() const override { return controller_.last_frame().start; }
  [[nodiscard]] bool finished() const override { return now() >= track_.end(); }
  [[nodiscard]] bool moving() const override {
    const auto before = track_.metres_at(now() - 200ms);
    const auto after = track_.metres_at(now());
    return std::abs(after[0] - before[0]) + std::abs(after[1] - before[1]) > 0.04;
  }
  void inject(const Fault& fault) override {
    wheels_.inject(fault);
    lidar_.inject(fault);
    imu_.inject(fault);
  }
  [[nodiscard]] Publication publication() const override {
    const PoseEstimate& estimate = controller_.estimate();
    return {.now = now(),
            .stamp = estimate.stamp,
            .map_T_base = estimate.map_T_base,
            .odom_T_base = estimate.odom_T_base,
            .state = estimate.state,
            .reason = estimate.reason};
  }
  [[nodiscard]] const auto& controller() const { return controller_; }

 private:
  static ControllerConfig config(const LogTrack& track, Duration scan_period, Duration lidar_age) {
    ControllerConfig config;
    config.drive = {.left_radius_m = 0.1, .right_radius_m = 0.1, .track_m = kLogTrack_m};
    config.drive.counts_per_revolution = 0.2 * std::numbers::pi / kLogMetresPerCount;
    config.dead_reckoning.use_gyro = track.has_gyro();
    config.health.expects_gyro = track.has_gyro();
    config.health.max_lidar_age = scan_period * 5 / 2 + lidar_age;
    config.health.max_match_age = scan_period * 3 + lidar_age;
    config.health.max_blind = scan_period * 5 + lidar_age;
    config.undistort.base_T_lidar = to_f32(track.base_T_lidar());
    config.undistort.limits = {.min_m = 0.05F, .max_m = 30.0F};
    config.lidar_age = lidar_age;
    // Wheels that jitter by 5 cm and 2 deg from scan to scan contradict the lidar without any
    // fault.
    if (!track.has_gyro()) {
      config.trust.max_correction_m = 0.10F;
      config.trust.max_pull_m = 0.15F;
    }
    return config;
  }

  const LogTrack& track_;
  sim::SimClock clock_;
  sim::SimCycleCounter cycles_{clock_};
  sim::SimWatchdog watchdog_{clock_, 500ms};
  LogBus bus_{clock_};
  LogWheels wheels_driver_;
  LogLidar lidar_driver_;
  LogImu imu_driver_;
  FaultyWheels<LogWheels> wheels_;
  FaultyLidar<LogLidar> lidar_;
  FaultyImu<LogImu> imu_;
  EventRing events_{};
  Controller<SiteProfile, FaultyWheels<LogWheels>, FaultyLidar<LogLidar>, FaultyImu<LogImu>>
      controller_;
};

}  // namespace picolo::test
