// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The files that a drive leaves in its folder.
#pragma once

#include <filesystem>
#include <string>

#include "drive_result.hpp"
#include "picolo/host/ape.hpp"

namespace picolo::tool {

/// How far trajectory and odometry are from the truth; no pairs when there is none.
struct DriveErrors {
  host::ApeSummary trajectory;
  host::ApeSummary odometry;
};
[[nodiscard]] DriveErrors evaluate(const DriveResult& drive);

/// trajectory.tum, odometry.tum, map.pgm + map.yaml, picture.svg + picture.png; truth.tum when
/// `with_truth_file`. Throws UserError (usage, device).
void write_drive(const DriveResult& drive, const DriveErrors& errors, const std::string& title,
                 bool with_truth_file, const std::filesystem::path& folder);

}  // namespace picolo::tool
