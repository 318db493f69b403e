// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The vehicle as its owner describes it in a configuration file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "picolo/controller/controller_config.hpp"
#include "picolo/devices/registry.hpp"

namespace picolo::tool {

/// The defaults are the nominal sizes of the simulated vehicle.
struct VehicleSettings {
  VehicleSettings();

  std::string profile = "site";
  ControllerConfig controller{};
  std::string wheels_name = "canopen";
  std::string lidar_name = "ld06";
  std::string imu_name = "witmotion";
  devices::WheelsSettings wheels{};
  devices::LidarSettings lidar{};
  devices::ImuSettings imu{};
  /// The configured rate alone, or all that the driver tries; after reading never empty.
  std::vector<std::uint32_t> lidar_bauds{};
  std::vector<std::uint32_t> imu_bauds{};
};

/// [vehicle] [wheels] [lidar] [imu] [can] [cycle] and [localiser]; whatever else is in the file is
/// refused. Throws UserError (usage).
[[nodiscard]] VehicleSettings read_vehicle(const std::string& path);

/// What the wheels and the controller's own frames both want, in words; empty when nothing.
[[nodiscard]] std::string overlap_of(const VehicleSettings& settings,
                                     const std::vector<CanFilter>& wheels);

}  // namespace picolo::tool
