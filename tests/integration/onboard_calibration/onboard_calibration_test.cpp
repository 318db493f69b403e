// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The vehicle calibrates itself on simulated wires: started by a CAN frame, watched through CAN
// frames, its pose undisturbed.

#include "picolo/controller/onboard_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "picolo/controller/calibration_store.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "support/wired_drive.hpp"

namespace picolo {
namespace {

using test::calibration_drive;
using test::WiredDrive;

constexpr Duration kDrive = 170s;

/// How far dead reckoning by wheels alone has gone astray after a minute.
double astray_m(ControllerConfig config) {
  config.dead_reckoning.use_gyro = false;
  config.health.expects_gyro = false;
  auto drive = std::make_unique<WiredDrive>(ControllerServices{}, config);
  drive->until(60s);
  const PoseEstimate& estimate = drive->robot.controller().estimate();
  const Result<Pose2d> truth = drive->robot.true_map_T_base(estimate.stamp);
  return std::hypot(estimate.odom_T_base.x_m - truth->x_m, estimate.odom_T_base.y_m - truth->y_m);
}

TEST(OnboardCalibration, IsStartedWatchedAndFinishedOverCan) {
  std::vector<std::uint8_t> memory(1024);
  sim::SimByteStore flash{memory, 512, 8};
  CalibrationStore store{flash};
  OnboardCalibrationConfig config = onboard_calibration(simulated_vehicle_config());
  auto calibration = std::make_unique<OnboardCalibration<360>>(config, &store);
  auto run = std::make_unique<WiredDrive>(ControllerServices{.calibration = &calibration->core()});
  run->until(1s);
  run->send(CommandKind::start_calibration, kCalibrateAll);
  run->until(3s);
  EXPECT_EQ(run->ear.signal(can_table::kCalibration, 0),
            static_cast<int>(CalibrationPhase::standstill));
  EXPECT_EQ(run->ear.signal(can_table::kCalibrationHint, 0),
            static_cast<int>(DriveAdvice::stand_still));
  run->until(60s);
  EXPECT_EQ(run->ear.signal(can_table::kCalibration, 0),
            static_cast<int>(CalibrationPhase::collecting));
  EXPECT_GT(run->ear.signal(can_table::kCalibration, 5), 100) << "samples";
  EXPECT_GT(run->ear.signal(can_table::kCalibrationHint, 2), 0) << "percent of the track";
  run->until(150s);
  if (calibration->core().routine().phase() == CalibrationPhase::collecting) {
    run->send(CommandKind::start_calibration, kFinishCalibration);
  }
  run->until(kDrive);
  const CalibrationRoutine& routine = calibration->core().routine();
  std::printf("std %.5f %.5f %.5f %.5f %.5f %.5f; matched %u failed %u, %u dropped\n",
              routine.record().drive_std[0], routine.record().drive_std[1],
              routine.record().drive_std[2], routine.record().drive_std[3],
              routine.record().drive_std[4], routine.record().drive_std[5],
              calibration->scans().matched, calibration->scans().failed, routine.scans_dropped());
  ASSERT_EQ(routine.phase(), CalibrationPhase::done)
      << to_string(routine.refusal().parameter) << ": " << to_string(routine.refusal().reason);
  EXPECT_EQ(run->ear.signal(can_table::kCalibration, 0), static_cast<int>(CalibrationPhase::done));

  CalibrationRecord record;
  ASSERT_EQ(store.load(record), Status::ok);
  const sim::SimulationConfig truth = calibration_drive();
  std::printf("r_L %.5f r_R %.5f b %.5f, lidar %.5f %.5f %.5f, clock %.5f, gyro %.5f %.5f\n",
              record.drive.radius_left_m, record.drive.radius_right_m, record.drive.track_m,
              record.drive.base_T_lidar.x_m, record.drive.base_T_lidar.y_m,
              record.drive.base_T_lidar.theta_rad, record.time_offset_s, record.gyro_scale,
              record.gyro_offset_s);
  EXPECT_NEAR(record.drive.radius_left_m, truth.vehicle.radius_left_m, 1e-3 * 0.1);
  EXPECT_NEAR(record.drive.radius_right_m, truth.vehicle.radius_right_m, 1e-3 * 0.1);
  EXPECT_NEAR(record.drive.track_m, truth.vehicle.track_m, 1e-3 * 0.5);
  EXPECT_NEAR(record.drive.base_T_lidar.x_m, truth.lidar.base_T_lidar.x_m, 0.002);
  EXPECT_NEAR(record.drive.base_T_lidar.y_m, truth.lidar.base_T_lidar.y_m, 0.002);
  EXPECT_NEAR(record.drive.base_T_lidar.theta_rad, truth.lidar.base_T_lidar.theta_rad, 0.00175);

  const ImuMountReport& mount = routine.mount_report();
  std::printf("IMU yaw %.4f +- %.4f\n", mount.yaw_rad.value, mount.yaw_rad.std);
  ASSERT_FALSE(mount.refusal) << to_string(mount.refusal.reason);
  EXPECT_NEAR(mount.yaw_rad.value, 0.0, 0.03);

  ControllerConfig better = simulated_vehicle_config();
  apply(record, better);
  EXPECT_TRUE(better.valid());
  const double before_m = astray_m(simulated_vehicle_config());
  const double after_m = astray_m(better);
  std::printf("dead reckoning astray after a minute: %.3f m, calibrated %.3f m\n", before_m,
              after_m);
  EXPECT_LT(after_m, 0.1 * before_m);
  EXPECT_EQ(onboard_calibration(better).routine.known_lidar_age_s,
            to_seconds_f64(better.lidar_age));
}

// Without frames of the controller on the bus, whose length would move the stamps of the wheels.
TEST(OnboardCalibration, ThePoseIsTheSameToTheLastBit) {
  ControllerConfig quiet = simulated_vehicle_config();
  quiet.frames_out.enabled = false;
  auto calibration = std::make_unique<OnboardCalibration<360>>(onboard_calibration(quiet));
  auto with =
      std::make_unique<WiredDrive>(ControllerServices{.calibration = &calibration->core()}, quiet);
  ASSERT_EQ(calibration->core().start(kCalibrateAll, with->robot.simulation().now()), Status::ok);
  with->until(90s);
  EXPECT_GT(calibration->scans().matched, 300U);
  auto alone = std::make_unique<WiredDrive>(ControllerServices{}, quiet);
  alone->until(90s);
  EXPECT_EQ(with->hash.value(), alone->hash.value());
}

}  // namespace
}  // namespace picolo
