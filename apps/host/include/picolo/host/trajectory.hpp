// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Trajectories: TUM ("stamp x y z qx qy qz qw") and KITTI (3x4 matrix a line) text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "picolo/host/diagnostics.hpp"
#include "picolo/host/line_reader.hpp"

namespace picolo::host {

/// A pose of the plane at the stamp that its log gave it.
struct TrajectoryPose {
  double stamp_s = 0.0;
  Pose2d pose{};
};
using Trajectory = std::vector<TrajectoryPose>;

/// Stamps with 6 decimals, metres and quaternions with 9: fixed notation, so that equal
/// trajectories are equal files. Throws UserError (usage, device).
void write_tum(const std::filesystem::path& path, std::span<const TrajectoryPose> poses);
void write_kitti(const std::filesystem::path& path, std::span<const TrajectoryPose> poses);

struct TumFile {
  std::string name;
  Trajectory poses;    ///< position x y and yaw, in file order
  std::string damage;  ///< see LineReader
};

/// Plain or .gz. A bad line is skipped with a warning; '#' starts a comment.
/// Throws UserError (input) when the file cannot be opened or holds no pose.
[[nodiscard]] TumFile read_tum(LineReader& reader, Diagnostics& diagnostics);

}  // namespace picolo::host
