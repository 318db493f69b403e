// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A whole vehicle firmware around picolo: devices, controller, cycle. All memory is static, nothing
// is allocated.

#include "board.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"

namespace {

using namespace picolo;

constexpr ControllerConfig vehicle() {
  ControllerConfig config;
  config.drive = {
      .left_radius_m = 0.1, .right_radius_m = 0.1, .track_m = 0.5, .counts_per_revolution = 4096.0};
  config.undistort.base_T_lidar = {0.12F, 0.0F, 0.0F};
  return config;
}
static_assert(vehicle().valid(), "checked by the compiler, not by the robot");

board::Timer timer;
board::Can can;
board::Uart lidar_line{230'400};
board::Uart imu_line{115'200};
board::Dog watchdog;

CanopenWheels wheels{can, {.produce_sync = true}};  // nodes 1 and 2, CiA 402
Ld06 lidar{lidar_line};
WitMotion imu{imu_line};
EventRing events;  // on a board: in memory that start-up code leaves alone
Controller<RoomProfile, CanopenWheels, Ld06, WitMotion> controller{
    {can, timer, timer, watchdog}, wheels, lidar, imu, events, vehicle()};

/// Your motion control, of any priority: reading the pose never waits.
void control_motion() {
  PoseEstimate pose;
  const bool may_drive = controller.read_pose(pose) && pose.state == HealthState::tracking;
  (void)may_drive;
}

}  // namespace

int main() {
  if (controller.start() != Status::ok) { return 1; }
  while (timer.sleep_until(controller.next_frame())) {
    (void)controller.run_frame();
    control_motion();
  }
  return controller.estimate().state == HealthState::initialising ? 0 : 1;  // nothing is connected
}
