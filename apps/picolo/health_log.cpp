// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "health_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "picolo/controller/pipeline.hpp"
#include "picolo/simulated/log_config.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kShown = 24;
constexpr Duration kNever = 24h;

// A leap within the limits of a log is one all the same when what is seen from there fits less.
constexpr float kLeapShare = 0.3F;
constexpr float kLeapAgreement = 0.9F;

HealthConfig by_matches_alone(bool in_given_map) {
  HealthConfig config;
  if (in_given_map) { config.lost_rejections = 5; }
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

ScanHealth::ScanHealth(bool in_given_map)
    : in_given_map_{in_given_map},
      limits_{trust_of_log(in_given_map)},
      trust_{limits_},
      monitor_{by_matches_alone(in_given_map)} {
  if (in_given_map) { trust_.distrust(); }
}

void ScanHealth::guide(LocaliserCore& localiser) const {
  if (!in_given_map_) { return; }
  localiser.doubt(trust_.unproven());
  if (leapt_) { localiser.verify(false); }
}

void ScanHealth::judge(Timestamp stamp, const LocaliserCore& localiser, bool founding) {
  const MatchReport& report = localiser.report();
  const bool accepted = localiser.accepted();
  const Pose2f& moved = localiser.last_correction();
  const float share = localiser.agreement() < kLeapAgreement ? kLeapShare : 1.0F;
  const bool leapt = accepted && !localiser.relocalised() &&
                     (std::hypot(moved.x_m, moved.y_m) > share * limits_.max_leap_m ||
                      std::abs(moved.theta_rad) > share * limits_.max_leap_rad);
  leapt_ = leapt && !localiser.unverified();
  trust_.matched({.accepted = accepted,
                  .rejection = why_rejected(report.outcome),
                  .inlier_share = founding ? 1.0F : report.inlier_share,
                  .agreement = localiser.agreement(),
                  .leapt = leapt});
  if (accepted) {
    direction_unobservable_ = !founding && report.outcome == MatchOutcome::degenerate;
    const Matrix3f covariance = localiser.match_covariance();
    position_variance_m2_ = founding ? 0.0F : covariance(0, 0) + covariance(1, 1);
  }
  HealthInputs inputs{.now = stamp};
  inputs.accepted_streak = trust_.accepted_streak();
  inputs.rejected_streak = trust_.rejected_streak();
  inputs.rejection = trust_.rejection();
  inputs.direction_unobservable = direction_unobservable_;
  inputs.unproven = trust_.unproven();
  inputs.unverified = trust_.unproven() && localiser.unverified();
  inputs.ambiguous = localiser.ambiguous();
  inputs.position_variance_m2 = position_variance_m2_;
  const HealthTransition change = monitor_.update(inputs);
  const auto lost = [](HealthState state) {
    return state == HealthState::lost || state == HealthState::relocalising;
  };
  if (lost(change.to) && !lost(change.from)) { trust_.distrust(); }
}

}  // namespace picolo::tool
