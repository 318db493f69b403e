// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What `picolo run` composes, on an MPS2 board: devices on real UARTs, controller, calibration
/// routine, maps and calibrations in flash.
#pragma once

#include "picolo/controller/calibration_store.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/controller/onboard_calibration.hpp"
#include "picolo/controller/stored_maps.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/slcan/slcan_bus.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/mps2/mps2_board.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo {

class FreeRunningRobot {
 public:
  using Type = Controller<RoomProfile, CanopenWheels, Ld06, WitMotion>;
  static constexpr std::size_t kCalibrationPoints = 450;

  FreeRunningRobot(mps2::Mps2Board& board, EventRing& events)
      : records_(board.store),
        maps_(board.store, {.address = 2 * mps2::kStoreSector}),
        config_(stored_config(records_)),
        can_(board.can),
        wheels_(can_, simulated_wheels_config()),
        lidar_(board.lidar),
        imu_(board.imu),
        calibration_(onboard_calibration(config_), &records_),
        controller_({can_, board.clock, board.cycles, board.watchdog}, wheels_, lidar_, imu_,
                    events, config_, {.maps = &maps_, .calibration = &calibration_.core()}) {}
  FreeRunningRobot(const FreeRunningRobot&) = delete;
  FreeRunningRobot& operator=(const FreeRunningRobot&) = delete;
  ~FreeRunningRobot() = default;

  Status start() { return controller_.start(); }
  /// Runs the frame that is due. Called after a tick it waits the few microseconds by which frames
  /// are released later than ticks come.
  void run_frame() {
    while (controller_.run_frame() == Status::not_ready) {}
  }

  [[nodiscard]] const Type& controller() const { return controller_; }
  [[nodiscard]] const SlcanBus& can() const { return can_; }
  [[nodiscard]] const Ld06& lidar() const { return lidar_; }

 private:
  /// What was calibrated on this board replaces what was configured.
  static ControllerConfig stored_config(CalibrationStore& records) {
    ControllerConfig config = simulated_vehicle_config();
    // For 500 million instructions a second, software doubles of the Cortex-M4F included. The
    // calibration takes its copy of a sweep while that is undistorted; the map's window moves in
    // one piece.
    config.work.max_returns = 256;
    config.work.max_point_iterations = 1800;
    config.budgets = {.can = Duration{200},
                      .serial = Duration{200},
                      .odometry = Duration{200},
                      .undistort = Duration{900},
                      .match = Duration{1100},
                      .map = Duration{1500},
                      .background = Duration{600},
                      .report = Duration{300}};
    CalibrationRecord record;
    if (is_ok(records.load(record))) { apply(record, config); }
    return config;
  }

  CalibrationStore records_;
  StoredMaps maps_;
  ControllerConfig config_;
  SlcanBus can_;
  CanopenWheels wheels_;
  Ld06 lidar_;
  WitMotion imu_;
  OnboardCalibration<kCalibrationPoints> calibration_;
  Type controller_;
};

}  // namespace picolo
