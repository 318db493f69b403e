// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A log through one matcher alone: what the rest of the estimator is worth shows beside it.
#pragma once

#include "drive_result.hpp"
#include "replay_input.hpp"
#include "scan_matcher.hpp"

namespace picolo::tool {

/// Prediction by odometry, one match, and the scan joins the map wherever the match has put it. A
/// match that gave no pose leaves the prediction. Not for logs that were given a map.
[[nodiscard]] DriveResult replay_with_matcher(const ReplayInput& input,
                                              const ReplaySettings& settings, MatcherKind kind);

/// Every return of the scan to the instant of its first. Keeps the storage of its result.
class ScanPoints {
 public:
  explicit ScanPoints(const ReplayInput& input) : input_{input} {}
  /// Scans in the order of the log. Null when odometry does not cover the scan.
  [[nodiscard]] const UndistortedSweep* of(const ReplayScan& scan);

 private:
  const ReplayInput& input_;
  PoseBuffer<256> poses_;
  Undistorter<SiteProfile::kReturns> undistorter_;
  std::size_t next_pose_ = 0;
};

}  // namespace picolo::tool
