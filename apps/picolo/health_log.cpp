// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "health_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "picolo/controller/pipeline.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kShown = 24;
constexpr Duration kNever = 24h;

HealthConfig by_matches_alone() {
  HealthConfig config;
  config.expects_gyro = false;
  config.max_match_age = kNever;
  return config;
}

std::size_t index_of(HealthState state) {
  return static_cast<std::size_t>(state);
}

}  // namespace

void HealthLog::at_scan(double stamp_s, std::size_t scan, HealthState state, HealthReason reason) {
  if (state != state_) { changes.push_back({stamp_s, scan, state_, state, reason}); }
  state_ = state;
  ++scans[index_of(state)];
}

host::Json to_json(const HealthLog& log) {
  host::Json json;
  for (std::size_t k = 0; k < kHealthStates; ++k) {
    json["scans"][to_string(static_cast<HealthState>(k))] = log.scans[k];
  }
  json["changes"] = host::Json::array();
  for (const HealthChange& change : log.changes) {
    json["changes"].push_back({{"stamp", change.stamp_s},
                               {"scan", change.scan},
                               {"from", to_string(change.from)},
                               {"to", to_string(change.to)},
                               {"reason", to_string(change.reason)}});
  }
  return json;
}

std::string to_lines(const HealthLog& log) {
  std::string text = "health:";
  for (std::size_t k = 0; k < kHealthStates; ++k) {
    if (log.scans[k] == 0) { continue; }
    text += fmt::format(" {} {} scans,", to_string(static_cast<HealthState>(k)), log.scans[k]);
  }
  text.back() = '\n';
  const std::size_t shown = std::min(log.changes.size(), kShown);
  for (std::size_t k = 0; k < shown; ++k) {
    const HealthChange& change = log.changes[k];
    text += fmt::format("  scan {} ({:.3f} s): {} -> {} ({})\n", change.scan, change.stamp_s,
                        to_string(change.from), to_string(change.to), to_string(change.reason));
  }
  if (shown < log.changes.size()) {
    text += fmt::format("  and {} more; --json lists all\n", log.changes.size() - shown);
  }
  return text;
}

ScanHealth::ScanHealth() : monitor_{by_matches_alone()} {}

void ScanHealth::judge(Timestamp stamp, const LocaliserCore& localiser, bool founding) {
  const MatchReport& report = localiser.report();
  if (localiser.accepted()) {
    ++accepted_streak_;
    rejected_streak_ = 0;
    direction_unobservable_ = !founding && report.outcome == MatchOutcome::degenerate;
    const Matrix3f covariance = localiser.match_covariance();
    position_variance_m2_ = founding ? 0.0F : covariance(0, 0) + covariance(1, 1);
  } else {
    ++rejected_streak_;
    accepted_streak_ = 0;
  }
  HealthInputs inputs{.now = stamp};
  inputs.accepted_streak = accepted_streak_;
  inputs.rejected_streak = rejected_streak_;
  inputs.rejection = why_rejected(report.outcome);
  inputs.direction_unobservable = direction_unobservable_;
  inputs.position_variance_m2 = position_variance_m2_;
  static_cast<void>(monitor_.update(inputs));
}

}  // namespace picolo::tool
