// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The simulated vehicle speaks LD06, WitMotion and CANopen. A dialect stands between it and a
/// driver and says the same in the bytes of another device, at the same times, so that every driver
/// can be driven: `port = make_lidar_dialect("rplidar", simulation.lidar_port())`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0::devices {

/// The interfaces have no public destructor: the deleter knows what it deletes.
using SerialPortPointer = std::unique_ptr<SerialPort, void (*)(SerialPort*)>;
using CanBusPointer = std::unique_ptr<CanBus, void (*)(CanBus*)>;

/// rplidar (in each of its modes), ydlidar (three bytes a sample,
/// optics of the T-mini) and scip (338 of 450 steps a turn) obey their commands: start, stop, info,
/// health, parameters. ld06 passes through. Throws std::invalid_argument for others.
[[nodiscard]] SerialPortPointer make_lidar_dialect(const std::string& name, SerialPort& ld06,
                                                   const std::string& mode = "");
/// Such a lidar needs a simulated LD06 that turns so too (Ld06ModelConfig::counter_clockwise).
[[nodiscard]] bool turns_counter_clockwise(const std::string& name);
/// xsens, vectornav, bno08x-rvc; witmotion passes through.
[[nodiscard]] SerialPortPointer make_imu_dialect(const std::string& name, SerialPort& witmotion);

struct WheelDialect {
  std::uint32_t left_id = 1;  ///< in the dialect
  std::uint32_t right_id = 2;
  std::uint32_t pole_pairs = 7;          ///< vesc
  std::uint32_t counts_per_turn = 4096;  ///< of the simulated encoders
  std::uint8_t left_node = 1;            ///< CANopen nodes of the simulated vehicle
  std::uint8_t right_node = 2;
};
/// odrive, vesc, dbc (comma body's MOTORS_ANGLE: identifier 0x205, two big-endian words that wrap
/// at 16384); canopen passes through. Starts the CANopen nodes and sends their SYNC by itself.
[[nodiscard]] CanBusPointer make_wheel_dialect(const std::string& name, CanBus& canopen,
                                               Clock& clock, const WheelDialect& settings = {});

}  // namespace picolo::inline v0::devices
