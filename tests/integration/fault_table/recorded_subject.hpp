// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recorded log through the installed controller. No log with a lidar has an IMU: there is none,
/// or its gyro tells the headings of a reference.
#pragma once

#include <cmath>
#include <numbers>

#include "faulty_devices.hpp"
#include "log_devices.hpp"
#include "log_track.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_watchdog.hpp"
#include "subject.hpp"

namespace picolo::test {

class RecordedSubject final : public Subject {
 public:
  /// `scan_period`: of the log, for the limits of age.
  RecordedSubject(const LogTrack& track, Duration scan_period)
      : track_(track),
        wheels_driver_(track),
        lidar_driver_(track, clock_),
        imu_driver_(track, clock_),
        wheels_(wheels_driver_),
        lidar_(lidar_driver_, clock_),
        imu_(imu_driver_, clock_),
        controller_({bus_, clock_, cycles_, watchdog_}, wheels_, lidar_, imu_, events_,
                    config(track, scan_period)) {
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
  static ControllerConfig config(const LogTrack& track, Duration scan_period) {
    ControllerConfig config;
    config.drive = {.left_radius_m = 0.1, .right_radius_m = 0.1, .track_m = kLogTrack_m};
    config.drive.counts_per_revolution = 0.2 * std::numbers::pi / kLogMetresPerCount;
    config.dead_reckoning.use_gyro = track.has_gyro();
    config.health.expects_gyro = track.has_gyro();
    config.health.max_lidar_age = scan_period * 5 / 2;
    config.health.max_match_age = scan_period * 3;
    config.health.max_blind = scan_period * 5;
    config.undistort.base_T_lidar = to_f32(track.base_T_lidar());
    config.undistort.limits = {.min_m = 0.05F, .max_m = 30.0F};
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
