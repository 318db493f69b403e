// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What lives at the wires of a lockstep run: the simulated vehicle, or a recorded log.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "picolo/controller/command_gate.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sim/sim_can_bus.hpp"
#include "picolo/sim/sim_serial_port.hpp"
#include "picolo/sim/simulation.hpp"

namespace picolo::target {

class Drive {
 public:
  Drive() = default;
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;
  virtual ~Drive() = default;
  [[nodiscard]] virtual Timestamp now() = 0;
  virtual void advance_to(Timestamp now) = 0;
  [[nodiscard]] virtual bool over() = 0;
  [[nodiscard]] virtual sim::SimCanBus& can() = 0;
  [[nodiscard]] virtual sim::SimSerialPort& lidar_port() = 0;
  [[nodiscard]] virtual sim::SimSerialPort* imu_port() = 0;
  /// See on_a_log.
  [[nodiscard]] virtual bool recorded() const = 0;
  /// In the controller's map frame, where it is known.
  [[nodiscard]] virtual std::optional<Pose2d> true_map_T_base(Timestamp stamp) = 0;
};

/// A command that is sent so long after the start.
struct TimedCommand {
  Duration after{};
  Command command{};
};

std::unique_ptr<Drive> simulated_drive(const sim::SimulationConfig& config, Duration length,
                                       std::vector<TimedCommand> commands = {});
std::unique_ptr<Drive> simulated_drive(sim::SceneName scene, Duration length);

/// The first `scans` scans of a CARMEN log after `skip` others, through the wires of the simulated
/// vehicle: its wheels turn as the log's odometry says, and stand while a scan is taken.
std::unique_ptr<Drive> recorded_drive(const std::string& file, std::size_t skip, std::size_t scans);

}  // namespace picolo::target
