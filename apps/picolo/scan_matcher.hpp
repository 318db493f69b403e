// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The library's matchers behind one interface, each alone: no acceptance, no health, no second
/// thought.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "picolo/localisation/localiser.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/match_report.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::tool {

enum class MatcherKind { gn, lm, ndt, correlative, plicp };

inline constexpr const char* kMatcherNames = "gn, lm, ndt, correlative or plicp";
/// Throws UserError (usage) for an unknown name.
[[nodiscard]] MatcherKind matcher_kind(const std::string& name);
[[nodiscard]] const char* title_of(MatcherKind kind);

/// The outcomes whose pose is more than the start handed back.
[[nodiscard]] bool is_pose(MatchOutcome outcome);

struct ScanMatch {
  MatchReport report{};  ///< pose and information in a frame of the matcher's own
  Pose2d map_T_base{};
  Matrix3f covariance{};  ///< of map_T_base, axes of the map
};

/// How far the guess may be off.
struct GuessSigma {
  float translation_m = 0.1F;
  float rotation_rad = 0.1F;
};

/// `match`, then `add` at the pose that was decided on. Neither takes memory from the heap.
class ScanMatcher {
 public:
  ScanMatcher() = default;
  ScanMatcher(const ScanMatcher&) = delete;
  ScanMatcher& operator=(const ScanMatcher&) = delete;
  virtual ~ScanMatcher() = default;

  /// Before each scan: what lies far from there may be forgotten.
  virtual void follow(const Pose2d& map_T_base) = 0;
  [[nodiscard]] virtual ScanMatch match(const UndistortedSweep& sweep, const Pose2d& guess,
                                        const GuessSigma& sigma) = 0;
  virtual void add(const UndistortedSweep& sweep, const Pose2d& map_T_base) = 0;
};

/// An occupancy map of 102 m, as large as profile site's.
using ScanMap = RollingMap<SiteProfile::kWidth, SiteProfile::kHeight>;
/// All beams of the scan into the map, and its field repaired.
void insert_scan(RollingMapCore& map, const UndistortedSweep& sweep, const Pose2d& map_T_base,
                 const LocaliserConfig& config);

/// Matchers on the field read `map`, which outlives them and which the caller fills by
/// `insert_scan`; the others keep a map, or a scan, of their own. Configuration of the residuals:
/// `config.fine`.
[[nodiscard]] std::unique_ptr<ScanMatcher> make_scan_matcher(MatcherKind kind,
                                                             const LocaliserConfig& config,
                                                             RollingMapCore& map);

// For make_scan_matcher.
[[nodiscard]] std::unique_ptr<ScanMatcher> make_ndt_matcher(float prior_weight);
[[nodiscard]] std::unique_ptr<ScanMatcher> make_plicp_matcher(float prior_weight);

/// A prior of the guess in the axes of the window, as the localiser's.
[[nodiscard]] PosePrior prior_of(const Pose2f& window_T_guess, const GuessSigma& sigma,
                                 float weight);

}  // namespace picolo::tool
