// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Two scans of recorded logs, and one matched with the other.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "replay_input.hpp"
#include "scan_matcher.hpp"

namespace picolo::tool {

/// A scan with points of its own, at the instant of its first return.
struct ChosenScan {
  std::vector<float> x_m;
  std::vector<float> y_m;
  UndistortedSweep sweep{};  ///< its points are the two above
  bool has_odometry = false;

  ChosenScan() = default;
  ChosenScan(const ChosenScan&) = delete;
  ChosenScan& operator=(const ChosenScan&) = delete;
  ~ChosenScan() = default;
  void keep(const UndistortedSweep& from);
};

/// The scans of a log by number, the first is 0. Throws UserError (usage) for one that the log does
/// not have, (refused) for one that its odometry does not cover.
[[nodiscard]] std::map<std::size_t, ChosenScan> read_scans(const std::string& log,
                                                           const std::set<std::size_t>& numbers,
                                                           const ReplaySettings& settings,
                                                           host::Diagnostics& diagnostics);

struct PairMatch {
  Pose2d guess{};  ///< reference_T_scan
  ScanMatch match{};
  double time_us = 0.0;
};

/// Matches a scan with what another one alone has drawn. Matchers on a field end on one of half the
/// cell's size: one scan's hits are too few to average out where in its cell each lies.
class PairMatcher {
 public:
  explicit PairMatcher(MatcherKind kind);
  [[nodiscard]] PairMatch match(const ChosenScan& reference, const ChosenScan& scan,
                                const Pose2d& guess);

 private:
  MatcherKind kind_;
  LocaliserConfig config_;
  std::unique_ptr<ScanMap> map_;
  std::unique_ptr<ScanMap> sharp_map_;
};

/// As `picolo match LOG --pairs FILE`: every pair that the file lists (`i j dx dy dtheta`: scan j's
/// pose in scan i's frame), from a guess as far off as `off_m` and `off_rad`, in random directions.
struct PairsOptions {
  std::string log;
  std::string pairs;
  std::string matcher;
  double off_m = 0.2;
  double off_rad = 0.1745329;
  bool json = false;
};
/// Prints how far the matches lie from what the file says.
void match_pairs(const PairsOptions& options, const ReplaySettings& settings);

}  // namespace picolo::tool
