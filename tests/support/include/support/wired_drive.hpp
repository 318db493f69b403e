// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A drive by which a vehicle can calibrate itself, commanded and watched over CAN. For tests that
/// link picolo::simulated.
#pragma once

#include <gtest/gtest.h>

#include <array>

#include "picolo/controller/command_gate.hpp"
#include "picolo/core/hash.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo::test {

/// Straights, turns on the spot, arcs and quick turns to and fro, within 3 m.
inline sim::SimulationConfig calibration_drive() {
  sim::SimulationConfig config{.seed = 5, .scene = sim::make_scene(sim::SceneName::room)};
  config.scene.world_T_start.theta_rad = 0.0;  // the figure needs the room's length ahead
  config.drive.stand_at_start = 4s;
  config.drive.max_speed_mps = 0.6;
  config.drive.max_omega_radps = 1.2;
  config.vehicle.slip_sigma = 0.0;  // a wheel that slips has no radius
  config.vehicle.scrub_s = 0.0;
  // Far from what the controller is told: 0.1 m, 0.5 m, and a lidar at (0.12, 0, 0).
  config.vehicle.radius_left_m = 0.0985;
  config.vehicle.radius_right_m = 0.101;
  config.vehicle.track_m = 0.515;
  config.lidar.base_T_lidar = {0.13, 0.01, 0.02};
  const sim::TwistPiece figure[] = {{4s, 0.0, 0.9},  {4s, 0.5, 0.0},  {4s, -0.5, 0.0},
                                    {4s, 0.0, -0.9}, {5s, 0.4, 0.8},  {5s, -0.4, -0.8},
                                    {5s, 0.4, -0.8}, {5s, -0.4, 0.8}, {1s, 0.0, 1.1},
                                    {1s, 0.0, -1.1}, {1s, 0.0, 1.1},  {1s, 0.0, -1.1}};
  for (int round = 0; round < 5; ++round) {
    for (const sim::TwistPiece& piece : figure) { EXPECT_TRUE(config.script.push_back(piece)); }
  }
  return config;
}

/// Frames of the controller, by their identifier.
class Ear final : public sim::CanListener {
 public:
  void heard(const CanFrame& frame, bool from_firmware) override {
    if (!from_firmware) { return; }
    const auto offset = static_cast<std::size_t>(frame.id - FramesOutConfig{}.base_id);
    if (offset < kCanOwnIds) { newest[offset] = frame; }
  }
  [[nodiscard]] std::int64_t signal(const CanMessage& message, std::size_t index) const {
    const auto decoded = decode(message, FramesOutConfig{}.base_id, newest[message.offset]);
    return decoded ? decoded->raw[index] : -1;
  }
  std::array<CanFrame, kCanOwnIds> newest{};
};

struct WiredDrive {
  explicit WiredDrive(const ControllerServices& services,
                      const ControllerConfig& config = simulated_vehicle_config())
      : robot(calibration_drive(), config, nullptr, services) {
    robot.simulation().can().attach(&ear);
    EXPECT_EQ(robot.start(), Status::ok);
  }
  void send(CommandKind kind, std::uint8_t detail) {
    const Timestamp now = robot.simulation().now();
    CanFrame frame = encode_command(
        FramesOutConfig{}.base_id,
        {.kind = kind, .counter = ++counter, .tick = can_tick(now), .detail = detail});
    frame.stamp = now;
    robot.simulation().can().deliver(frame);
  }
  void until(Duration elapsed) {
    until(elapsed, [](auto& controller) { return controller.run_frame(); });
  }
  /// `run_frame(controller)`: one cycle, as the caller wants it watched.
  template <typename RunFrame>
  void until(Duration elapsed, RunFrame&& run_frame) {
    const Timestamp end = robot.simulation().config().start + elapsed;
    while (robot.controller().next_frame() < end) {
      robot.simulation().advance_to(robot.controller().next_frame());
      ASSERT_EQ(run_frame(robot.controller()), Status::ok);
      const PoseEstimate& estimate = robot.controller().estimate();
      for (const Pose2d* pose : {&estimate.map_T_base, &estimate.odom_T_base}) {
        hash.add(pose->x_m);
        hash.add(pose->y_m);
        hash.add(pose->theta_rad);
      }
    }
  }
  Ear ear;
  SimulatedController<RoomProfile> robot;
  Hash hash{};
  std::uint8_t counter = 0;
};

}  // namespace picolo::test
