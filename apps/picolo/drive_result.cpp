// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "drive_result.hpp"

#include "picolo/host/quantile.hpp"

namespace picolo::tool {

void add_counts(const DriveResult& drive, host::Json& json) {
  host::Json outcomes = host::Json::object();
  for (int i = 0; i < kMatchOutcomes; ++i) {
    outcomes[to_string(static_cast<MatchOutcome>(i))] = drive.counters.outcomes[i];
  }
  json["scans"] = drive.trajectory.size();
  json["matched"] = drive.counters.matched;
  json["outcomes"] = outcomes;
}

host::Json quantiles(const std::vector<double>& values) {
  return {{"p50", host::quantile(values, 0.50)}, {"p99", host::quantile(values, 0.99)}};
}

bool usable(const DriveResult& drive) {
  // the first scan only starts the map
  return drive.trajectory.size() < 2 ||
         2 * std::size_t{drive.counters.matched} >= drive.trajectory.size() - 1;
}

}  // namespace picolo::tool
