// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The vehicle that plays a log through wires, and what its controller is told about it.
#pragma once

#include <vector>

#include "picolo/controller/controller_config.hpp"
#include "picolo/drivers/canopen/canopen_wheels_config.hpp"
#include "picolo/sim/log_player.hpp"
#include "replay_input.hpp"

namespace picolo::tool {

[[nodiscard]] sim::LogPlayerConfig player_config();
[[nodiscard]] CanopenWheelsConfig wheels_config();
/// What a technician would configure for the vehicle of the player.
[[nodiscard]] ControllerConfig controller_config(const ReplayInput& input,
                                                 const ReplaySettings& settings);

using RecordedBeams = std::vector<std::vector<sim::RecordedBeam>>;
/// The beams that direct replay takes as measurements; on the wire the others have distance 0.
[[nodiscard]] RecordedBeams beams_of(const ReplayInput& input);
/// Views into `beams`, one a scan.
[[nodiscard]] std::vector<sim::LogStep> steps_of(const ReplayInput& input,
                                                 const RecordedBeams& beams);

}  // namespace picolo::tool
