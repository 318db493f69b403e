// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A log stop-and-scan through CAN frames and LD06 bytes, drivers and executive, in virtual time.
#pragma once

#include "drive_result.hpp"
#include "picolo/host/diagnostics.hpp"
#include "replay_input.hpp"

namespace picolo::tool {

/// One pose a scan, with the log's stamps; a scan that the controller did not take in time gets the
/// pose published while the vehicle stood there, and a warning counts them. Times are the
/// processor time of the tasks undistort, match, background and map.
/// Throws UserError (usage) for an unknown profile, or a log whose scans are not instants with
/// odometry.
[[nodiscard]] DriveResult replay_through_wires(const ReplayInput& input,
                                               const ReplaySettings& settings,
                                               host::Diagnostics& diagnostics);

}  // namespace picolo::tool
