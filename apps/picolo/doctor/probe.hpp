// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Looks at a bus or a line and gathers the facts.
#pragma once

#include <string>
#include <vector>

#include "doctor/findings.hpp"
#include "live/vehicle_settings.hpp"

namespace picolo::tool {

/// An interface, slcan:TTY or socket:PATH. Asks each node for its type (SDO, object 0x1000) and
/// listens for 1.2 s, longer than a heartbeat's usual period. Throws UserError (usage).
[[nodiscard]] CanFacts probe_can(const std::string& name, const VehicleSettings& settings);

/// Reads half a second at each rate, the configured one first; others only when that fails.
[[nodiscard]] SerialFacts probe_lidar(const std::string& path, const VehicleSettings& settings);
[[nodiscard]] SerialFacts probe_imu(const std::string& path, const VehicleSettings& settings);

}  // namespace picolo::tool
