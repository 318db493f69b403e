// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle behind a board's own devices: its nodes own the second CAN controller, its
/// lidar and IMU send through the UARTs that the controller reads.
#pragma once

#include <cstdint>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/sim/simulation.hpp"

namespace picolo {

/// What passed the bus, counted at the vehicle's end.
struct HeardOnBus {
  std::uint32_t starts = 0;  ///< NMT commands to start
  std::uint32_t syncs = 0;
  std::uint32_t service_requests = 0;
  std::uint32_t from_controller = 0;  ///< picolo's own messages
  std::uint32_t boot_ups = 0;
  std::uint32_t heartbeats = 0;
  std::uint32_t service_answers = 0;
  std::uint32_t service_aborts = 0;
  std::uint32_t process_data = 0;
  std::uint32_t foreign = 0;  ///< of a third node, for the acceptance filters
};

class VehicleOnWires {
 public:
  VehicleOnWires(const sim::SimulationConfig& config, CanBus& can, SerialPort& lidar,
                 SerialPort& imu)
      : simulation_(config), can_(can), lidar_(lidar), imu_(imu) {}
  VehicleOnWires(const VehicleOnWires&) = delete;
  VehicleOnWires& operator=(const VehicleOnWires&) = delete;
  ~VehicleOnWires() = default;

  /// Takes what the controller sent, lives until `now`, sends what became due. Call it every
  /// millisecond.
  void live(Timestamp now);
  [[nodiscard]] const sim::Simulation& simulation() const { return simulation_; }
  [[nodiscard]] const HeardOnBus& heard() const { return heard_; }
  /// The newest pose message on the bus.
  [[nodiscard]] const CanFrame& pose_frame() const { return pose_frame_; }
  /// Frames and bytes that a device had no room for.
  [[nodiscard]] std::uint32_t refused() const { return refused_; }

 private:
  void take_from_controller();
  void send_frames(Timestamp now);
  void send_bytes(sim::SimSerialPort& from, SerialPort& to);
  void send(const CanFrame& frame);

  sim::Simulation simulation_;
  CanBus& can_;
  SerialPort& lidar_;
  SerialPort& imu_;
  HeardOnBus heard_{};
  CanFrame pose_frame_{};
  Timestamp next_foreign_{};
  std::uint32_t refused_ = 0;
};

}  // namespace picolo
