// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A log straight into the localiser, without wires and cycle.
#pragma once

#include "drive_result.hpp"
#include "replay_input.hpp"

namespace picolo::tool {

/// Scan by scan in the order of the file. Times are processor time of this thread.
/// Throws UserError (usage) for an unknown profile, (refused) when a scan does not fit into it.
[[nodiscard]] DriveResult replay_directly(const ReplayInput& input, const ReplaySettings& settings);

}  // namespace picolo::tool
