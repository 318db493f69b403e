// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What `picolo run` composes, on an MPS2 board: devices on real UARTs, controller, calibration
/// routine, maps and calibrations in flash.
#pragma once

#include "picolo/controller/calibration_store.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/controller/last_words.hpp"
#include "picolo/controller/onboard_calibration.hpp"
#include "picolo/controller/stored_maps.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/slcan/slcan_bus.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/mps2/mps2_board.hpp"

namespace picolo {

/// More than three major frames: one in which a frame slips, and the next, entered in the middle,
/// may be incomplete. After as long again the board is reset.
inline constexpr Duration kWatchdogPeriod = 350ms;

/// Calibrations are in the first two sectors.
inline constexpr std::size_t kMapAddress = 2 * mps2::kStoreSector;

/// What stands between the robot and its board.
struct RobotWiring {
  mps2::Mps2Board& board;
  SerialPort& lidar;
  ByteStore& store;
  TaskPolicies policies{};
};

class FreeRunningRobot {
 public:
  using Type = Controller<RoomProfile, CanopenWheels, Ld06, WitMotion>;
  /// With more a slice of the scan match fills the frame of a Cortex-M4F.
  static constexpr std::size_t kCalibrationPoints = 240;

  /// Everything referred to outlives the robot.
  explicit FreeRunningRobot(const RobotWiring& wiring);
  FreeRunningRobot(const FreeRunningRobot&) = delete;
  FreeRunningRobot& operator=(const FreeRunningRobot&) = delete;
  ~FreeRunningRobot() = default;

  /// Before `start`: the map in flash becomes the one that is localised in. Status as
  /// Controller::load_map.
  Status load_map() { return controller_.load_map(stored_map_); }
  /// Devices, cycle and watchdog; the first frame runs at once.
  Status start();
  /// Called after a tick: runs all frames that are due. Waits the few microseconds by which frames
  /// are released later than ticks come.
  void run_frames();

  [[nodiscard]] const Type& controller() const { return controller_; }
  [[nodiscard]] const SlcanBus& can() const { return can_; }
  [[nodiscard]] const Ld06& lidar() const { return lidar_; }

 private:
  mps2::Mps2Board& board_;
  CalibrationStore records_;
  MapStore stored_map_;
  StoredMaps maps_;
  ControllerConfig config_;
  SlcanBus can_;
  CanopenWheels wheels_;
  Ld06 lidar_;
  WitMotion imu_;
  OnboardCalibration<kCalibrationPoints> calibration_;
  Type controller_;
};

/// Once, before the robot starts: what the run before left behind, when the watchdog ended it.
[[nodiscard]] Result<ResetReport> last_reset();
/// The controller's, in memory that survives a reset.
[[nodiscard]] const EventRing& events();

/// A number from the image's command line, 0 when there is none.
[[nodiscard]] std::uint32_t word_as_number(std::size_t index);
/// A line for the debugger.
void tell(const char* name, std::uint64_t value);
void tell_reset(const ResetReport& report, const Schedule& schedule);
/// How the cycle kept its releases, and each task its budget.
void tell_cycle(const Schedule& schedule);

}  // namespace picolo
