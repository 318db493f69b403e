// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The vehicle as its owner describes it in a configuration file.
#pragma once

#include <cstdint>
#include <string>

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
  std::uint32_t lidar_baud = 0;  ///< after reading never 0
  std::uint32_t imu_baud = 0;
};

/// [vehicle] [wheels] [lidar] [imu] [can] [cycle] and [localiser]; whatever else is in the file is
/// refused. Throws UserError (usage).
[[nodiscard]] VehicleSettings read_vehicle(const std::string& path);

}  // namespace picolo::tool
