// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far the pose could be trusted during a drive: every change of the health state.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "picolo/host/json.hpp"
#include "picolo/localisation/health.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/localisation/pose_trust.hpp"

namespace picolo::tool {

struct HealthChange {
  double stamp_s = 0.0;  ///< of the scan, as logged
  std::size_t scan = 0;
  HealthState from = HealthState::initialising;
  HealthState to = HealthState::initialising;
  HealthReason reason = HealthReason::none;
};

struct HealthLog {
  std::vector<HealthChange> changes;
  std::array<std::size_t, kHealthStates> scans{};  ///< that ended in each state

  /// The state in which a scan ended.
  void at_scan(double stamp_s, std::size_t scan, HealthState state, HealthReason reason);
  [[nodiscard]] HealthState state() const { return state_; }

 private:
  HealthState state_ = HealthState::initialising;
};

/// {"scans": {state: count}, "changes": [{stamp, scan, from, to, reason}]}.
[[nodiscard]] host::Json to_json(const HealthLog& log);
/// One line a change, at most a few dozen, then how many more; and the share of each state.
[[nodiscard]] std::string to_lines(const HealthLog& log);

/// The library's monitor over a log without cycle: judged once a scan, by the matches alone, since
/// the scans of a log may lie seconds apart.
class ScanHealth {
 public:
  explicit ScanHealth(bool in_given_map);
  /// Before the first scan, and after the match of each: in a given map, a pose that is in doubt is
  /// searched for.
  void guide(LocaliserCore& localiser) const;
  /// After the match of a scan. `founding`: the scan founded the map, there was nothing to match.
  void judge(Timestamp stamp, const LocaliserCore& localiser, bool founding);
  [[nodiscard]] HealthState state() const { return monitor_.state(); }
  [[nodiscard]] HealthReason reason() const { return monitor_.reason(); }

 private:
  bool in_given_map_;
  MatchTrust limits_;
  PoseTrust trust_;
  HealthMonitor monitor_;
  bool leapt_ = false;
  float position_variance_m2_ = 0.0F;
  bool direction_unobservable_ = false;
};

}  // namespace picolo::tool
