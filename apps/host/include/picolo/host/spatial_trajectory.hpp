// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Trajectories in space as evaluation needs them: TUM, KITTI and EuRoC text, read and written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "picolo/geometry/se3.hpp"
#include "picolo/host/diagnostics.hpp"
#include "picolo/host/line_reader.hpp"

namespace picolo::host {

enum class TrajectoryFormat : std::uint8_t {
  tum,    ///< stamp x y z qx qy qz qw, seconds
  kitti,  ///< the 3x4 matrix row by row, no stamps
  euroc,  ///< stamp,x,y,z,qw,qx,qy,qz[,...], nanoseconds
};

struct SpatialTrajectory {
  std::string name;
  TrajectoryFormat format = TrajectoryFormat::tum;
  std::vector<double> stamps_s;  ///< empty for KITTI
  std::vector<Transform3d> poses;
  std::string damage;  ///< see LineReader
};

/// Plain, .gz or pipe; the format is told from the first line that is no comment: by its commas and
/// its number of fields. A bad line is skipped with a warning. Poses with stamps are put in the
/// order of their stamps. Throws UserError (input): not opened, no pose, or of no known format.
[[nodiscard]] SpatialTrajectory read_spatial_trajectory(LineReader& reader,
                                                        Diagnostics& diagnostics);

/// Fixed notation: stamps with 9 decimals, numbers with 9. Stamps missing: TUM and EuRoC count
/// poses. Throws UserError (usage, device).
void write_spatial_trajectory(const std::filesystem::path& path,
                              const SpatialTrajectory& trajectory, TrajectoryFormat format);

}  // namespace picolo::host
