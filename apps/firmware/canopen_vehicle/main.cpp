// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The controller on the devices of the zcu102, all by interrupt: CAN0 with its acceptance filters,
// two UARTs (in loop-back), cycle timer, watchdog. In the same image the simulated vehicle plays on
// CAN1 and into the UARTs. Prints names and figures for tests/target/platforms to judge.

#include <algorithm>
#include <initializer_list>
#include <new>

#include "picolo/controller/controller.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/sim/ld06_wire.hpp"
#include "picolo/simulated/simulated_controller.hpp"
#include "picolo/zcu102/cadence_serial_port.hpp"
#include "picolo/zcu102/generic_timer.hpp"
#include "picolo/zcu102/interrupts.hpp"
#include "picolo/zcu102/xilinx_can_bus.hpp"
#include "platform.hpp"
#include "vehicle.hpp"

namespace picolo {
namespace {

constexpr Duration kDrive = 8s;

CanopenWheelsConfig wheels_config() {
  CanopenWheelsConfig config =
      two_cia402_drives(sim::WheelPairConfig{}.left.node, sim::WheelPairConfig{}.right.node);
  config.produce_sync = true;
  config.setup.enabled = true;
  return config;
}

struct Robot {
  zcu102::GenericClock clock;
  zcu102::GenericCycleCounter cycle_counter;
  zcu102::Interrupts interrupts;
  zcu102::CycleTimer timer;
  zcu102::TimerWatchdog watchdog;
  zcu102::XilinxCanBus can{clock, {.base = zcu102::kCan0}};
  zcu102::XilinxCanBus vehicle_can{clock, {.base = zcu102::kCan1}};
  zcu102::CadenceSerialPort lidar_port{
      clock, {.base = zcu102::kUart0, .baud = sim::kLd06Baud, .loop_back = true}};
  zcu102::CadenceSerialPort imu_port{
      clock, {.base = zcu102::kUart1, .baud = sim::WitMotionModelConfig{}.baud, .loop_back = true}};
  CanopenWheels wheels{can, wheels_config()};
  Ld06 lidar{lidar_port};
  WitMotion imu{imu_port};
  EventRing events{};
  Controller<RoomProfile, CanopenWheels, Ld06, WitMotion> controller{
      {can, clock, cycle_counter, watchdog},
      wheels,
      lidar,
      imu,
      events,
      simulated_vehicle_config()};
  VehicleOnWires vehicle{{.seed = 11, .start = clock.now()}, vehicle_can, lidar_port, imu_port};

  std::uint32_t poses_read = 0;  ///< pose messages that passed the bus whole
  double bus_deviation_m = 0.0;  ///< of the worst of them from the pose that was told

  Status start();
  void wait_for(Timestamp instant);
  /// Another node's view of a pose that was just told.
  void read_pose_off_the_bus();
};

alignas(64) constinit std::byte g_memory[sizeof(Robot)];
constinit Robot* g_robot = nullptr;

Status Robot::start() {
  // What the controller listens to: its nodes, and the commands to itself.
  FixedVector<CanFilter, CanopenWheels::Filters::capacity() + 1> filters;
  for (const CanFilter& filter : wheels.filters()) { static_cast<void>(filters.push_back(filter)); }
  const FramesOutConfig& out = controller.config().frames_out;
  static_cast<void>(filters.push_back({.id = out.base_id + std::uint32_t{kCanOwnIds},
                                       .mask = 0x7FFU & ~(std::uint32_t{kCanCommandIds} - 1)}));
  interrupts.start();
  const Status statuses[] = {interrupts.attach(zcu102::kCycleTimerInterrupt, timer),
                             interrupts.attach(zcu102::kWatchdogInterrupt, watchdog),
                             interrupts.attach(zcu102::kCan0Interrupt, can),
                             interrupts.attach(zcu102::kCan1Interrupt, vehicle_can),
                             interrupts.attach(zcu102::kUart0Interrupt, lidar_port),
                             interrupts.attach(zcu102::kUart1Interrupt, imu_port),
                             can.open(filters.view()),
                             vehicle_can.open(),
                             lidar_port.open(),
                             imu_port.open()};
  for (const Status status : statuses) {
    if (!is_ok(status)) { return status; }
  }
  watchdog.start(500ms);
  return controller.start();
}

/// The vehicle lives meanwhile.
void Robot::wait_for(Timestamp instant) {
  while (true) {
    const Timestamp now = clock.now();
    vehicle.live(now);
    if (now >= instant) { return; }
    timer.sleep_until(now + 1ms < instant ? now + 1ms : instant);
  }
}

void Robot::read_pose_off_the_bus() {
  constexpr const CanMessage& kPose = can_table::kPose;
  vehicle.live(clock.now());
  const auto values = decode(kPose, controller.config().frames_out.base_id, vehicle.pose_frame());
  if (!values) { return; }
  const Pose2d& pose = controller.estimate().map_T_base;
  const double off[] = {to_value(kPose.signals[0], values->raw[0]) - pose.x_m,
                        to_value(kPose.signals[1], values->raw[1]) - pose.y_m};
  for (const double value : off) {
    bus_deviation_m = std::max(bus_deviation_m, value < 0.0 ? -value : value);
  }
  ++poses_read;
}

struct Figure {
  const char* name;
  std::uint64_t value;
};

void tell(std::initializer_list<Figure> figures) {
  for (const Figure& figure : figures) {
    platform::write(figure.name);
    platform::write(" ");
    platform::write_decimal(figure.value);
    platform::write("\n");
  }
}

std::uint64_t micro(double value) {
  return static_cast<std::uint64_t>(
      round_to_i64(value < 0.0 ? -value * 1e6 : value * 1e6, 0, std::int64_t{1} << 40));
}

void tell_bus(const Robot& robot) {
  const HeardOnBus& heard = robot.vehicle.heard();
  tell({{"boot_ups", heard.boot_ups},
        {"heartbeats", heard.heartbeats},
        {"service_requests", heard.service_requests},
        {"service_answers", heard.service_answers},
        {"service_aborts", heard.service_aborts},
        {"starts", heard.starts},
        {"syncs", heard.syncs},
        {"process_data", heard.process_data},
        {"from_controller", heard.from_controller},
        {"foreign", heard.foreign},
        {"vehicle_refused", robot.vehicle.refused()}});
}

void tell_controller(const Robot& robot) {
  const CanStatus can = robot.can.status();
  const ControllerCounters& counters = robot.controller.counters();
  const CanopenWheelsCounters wheels = robot.wheels.counters();
  tell({{"can_received", can.received},
        {"can_transmitted", can.transmitted},
        {"can_lost", can.rx_lost + can.tx_refused},
        {"nodes_operational", robot.wheels.healthy() ? robot.wheels.node_count() : 0},
        {"setup_failures", wheels.setup_failures},
        {"controller_syncs", wheels.syncs_sent},
        {"controller_process_data", wheels.process_data},
        {"ticks", counters.ticks},
        {"readings", counters.readings},
        {"imu_samples", counters.imu_samples},
        {"serial_lost", robot.lidar_port.lost() + robot.imu_port.lost()},
        {"unexpected_interrupts", robot.interrupts.unexpected()},
        {"overruns", robot.controller.schedule().overruns()},
        {"timer_wake_ups", robot.timer.wake_ups()},
        {"watchdog_fired", std::uint64_t{robot.watchdog.fired()}}});
}

void tell_pose(const Robot& robot) {
  const PoseEstimate& estimate = robot.controller.estimate();
  const sim::Simulation& simulation = robot.vehicle.simulation();
  tell({{"matches", estimate.matches},
        {"state", static_cast<std::uint64_t>(estimate.state)},
        {"poses_read", robot.poses_read},
        {"bus_deviation_um", micro(robot.bus_deviation_m)}});
  if (const Result<sim::Truth> truth = simulation.truth(estimate.stamp)) {
    const Pose2d pose = between(simulation.config().scene.world_T_start, truth->world_T_base);
    tell({{"travelled_x_um", micro(pose.x_m)},
          {"error_x_um", micro(estimate.map_T_base.x_m - pose.x_m)},
          {"error_y_um", micro(estimate.map_T_base.y_m - pose.y_m)},
          {"error_yaw_urad", micro(wrap_angle(estimate.map_T_base.theta_rad - pose.theta_rad))}});
  }
}

int run() {
  Robot& robot = *new (g_memory) Robot;
  g_robot = &robot;
  if (!is_ok(robot.start())) { return 1; }
  const Timestamp end = robot.clock.now() + kDrive;
  std::uint32_t frames = 0;
  while (robot.controller.next_frame() < end) {
    robot.wait_for(robot.controller.next_frame());
    const std::uint32_t told = robot.controller.reporter().sent();
    if (!is_ok(robot.controller.run_frame())) { return 1; }
    if (robot.controller.reporter().sent() != told) { robot.read_pose_off_the_bus(); }
    ++frames;
  }
  tell({{"frames", frames}});
  tell_bus(robot);
  tell_controller(robot);
  tell_pose(robot);
  return 0;
}

}  // namespace
}  // namespace picolo

extern "C" void interrupt_handler() {
  picolo::g_robot->interrupts.serve();
}

extern "C" [[noreturn]] void fault_handler() {
  picolo::platform::write("the processor faulted\n");
  picolo::platform::leave(3);
}

int main() {
  picolo::platform::leave(picolo::run());
}
