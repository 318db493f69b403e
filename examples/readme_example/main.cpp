// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "picolo/controller/controller.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/sim/simulation.hpp"

// README: begin
using namespace picolo;

int main() {
  static sim::Simulation board{{.seed = 7}};                         // your board's port instead
  static CanopenWheels wheels{board.can(), {.produce_sync = true}};  // nodes 1 and 2, CiA 402
  static Ld06 lidar{board.lidar_port()};
  static WitMotion imu{board.imu_port()};
  static EventRing events;
  static Controller<RoomProfile, CanopenWheels, Ld06, WitMotion> controller{
      {board.can(), board.clock(), board.cycle_counter(), board.watchdog()},
      wheels,
      lidar,
      imu,
      events,
      {.drive = {.track_m = 0.5}, .undistort = {.base_T_lidar = {0.12F, 0.0F, 0.0F}}}};
  if (controller.start() != Status::ok) { return 1; }
  while (controller.next_frame() < Timestamp{30s}) {
    board.advance_to(controller.next_frame());  // on a board: sleep until then
    (void)controller.run_frame();
  }
  const PoseEstimate& pose = controller.estimate();
  std::printf("%s at x %.2f m, y %.2f m\n", to_string(pose.state), pose.map_T_base.x_m,
              pose.map_T_base.y_m);
  return pose.state == HealthState::tracking ? 0 : 1;
}
// README: end
