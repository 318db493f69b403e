// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recorded log made ready for the localiser.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "picolo/host/carmen.hpp"
#include "picolo/host/diagnostics.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/sensing/range_return.hpp"
#include "picolo/undistort/pose_buffer.hpp"

namespace picolo::tool {

struct ReplaySettings {
  std::string profile = "site";
  float min_range_m = 0.05F;
  float max_range_m = 30.0F;           ///< and less where the log states the scanner's own maximum
  std::optional<Pose2d> base_T_lidar;  ///< instead of what the log says
  bool use_odometry = true;
  std::string map;                    ///< file to localise in; empty: build one
  std::string save_map;               ///< file for the last window of the map; empty: none
  std::optional<Pose2d> map_T_start;  ///< of the vehicle at the first scan, instead of its odometry
  LocaliserConfig localiser{};
};

struct ReplayScan {
  std::size_t line = 0;
  double logged_s = 0.0;  ///< as the log has it, for the files written
  Timestamp stamp{};      ///< on the clock of the replay
  Timestamp last_stamp{};
  std::vector<RangeReturn> returns;
  RangeLimits limits{};
  Pose2f base_T_lidar{};
  Pose2d odom_T_base{};  ///< as logged, also when it is not used
};

struct ReplayInput {
  std::vector<ReplayScan> scans;
  std::vector<StampedPose> poses;  ///< odometry, stamps increasing; all identity when not used
  bool synthetic_clock = false;    ///< 0.1 s a scan: the log's stamps do not increase
  bool use_odometry = true;
};

/// Scans of FLASER and ROBOTLASER1 are instants with a pose of their own; without any, sweeps of
/// SWEEP lines, whose poses are the ODOM lines. Warns once about stamps that do not increase, and
/// about odometry that never moves, which is then not used.
/// Throws UserError (input) when there is neither.
[[nodiscard]] ReplayInput prepare(const host::CarmenLog& log, const ReplaySettings& settings,
                                  host::Diagnostics& diagnostics);

}  // namespace picolo::tool
