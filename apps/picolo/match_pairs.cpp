// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Many pairs of scans whose motion is known, each matched from a guess that is off.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/json.hpp"
#include "picolo/host/line_reader.hpp"
#include "picolo/host/quantile.hpp"
#include "scan_pair.hpp"

namespace picolo::tool {
namespace {

struct KnownPair {
  std::size_t reference = 0;
  std::size_t scan = 0;
  Pose2d reference_T_scan{};
};

std::vector<KnownPair> read_pairs(const std::string& path) {
  host::LineReader reader{path};
  std::vector<KnownPair> pairs;
  for (std::string_view line; reader.next(line);) {
    if (line.empty() || line.front() == '#') { continue; }
    std::istringstream words{std::string{line}};
    KnownPair pair;
    Pose2d& pose = pair.reference_T_scan;
    if (!(words >> pair.reference >> pair.scan >> pose.x_m >> pose.y_m >> pose.theta_rad)) {
      throw host::UserError{
          host::ExitCode::input, path,
          fmt::format("line {}: '{}' is no pair of scans", reader.line_number(), line),
          "each line is i j dx dy dtheta: numbers of two scans, the second's pose in the first's "
          "frame in metres and rad"};
    }
    pairs.push_back(pair);
  }
  if (pairs.empty()) {
    throw host::UserError{host::ExitCode::input, path, "lists no pair",
                          "each line is i j dx dy dtheta"};
  }
  return pairs;
}

}  // namespace

void match_pairs(const PairsOptions& options, const ReplaySettings& settings) {
  const std::vector<KnownPair> pairs = read_pairs(options.pairs);
  std::set<std::size_t> numbers;
  for (const KnownPair& pair : pairs) { numbers.insert({pair.reference, pair.scan}); }
  host::Diagnostics diagnostics;
  const auto scans = read_scans(options.log, numbers, settings, diagnostics);
  PairMatcher matcher{matcher_kind(options.matcher)};
  Random random{42};
  std::vector<double> off_m;
  std::vector<double> off_deg;
  std::vector<double> time_us;
  std::size_t found = 0;
  for (const KnownPair& pair : pairs) {
    const double direction_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double turn_rad = random.below(2) == 0 ? options.off_rad : -options.off_rad;
    const Pose2d& truth = pair.reference_T_scan;
    const PairMatch result = matcher.match(
        scans.at(pair.reference), scans.at(pair.scan),
        {truth.x_m + options.off_m * std::cos(direction_rad),
         truth.y_m + options.off_m * std::sin(direction_rad), truth.theta_rad + turn_rad});
    const Pose2d error = between(truth, result.match.map_T_base);
    off_m.push_back(std::hypot(error.x_m, error.y_m));
    off_deg.push_back(std::abs(wrap_angle(error.theta_rad)) * 180.0 / std::numbers::pi);
    time_us.push_back(result.time_us);
    found += off_m.back() < 0.1 && off_deg.back() < 2.0 ? 1U : 0U;
  }
  const double share = static_cast<double>(found) / static_cast<double>(pairs.size());
  const double median_m = host::quantile(off_m, 0.5);
  const double median_deg = host::quantile(off_deg, 0.5);
  if (options.json) {
    fmt::print("{}\n", host::to_text({{"matcher", options.matcher},
                                      {"pairs", pairs.size()},
                                      {"median_m", median_m},
                                      {"median_rad", median_deg * std::numbers::pi / 180.0},
                                      {"within_10cm_2deg", share},
                                      {"match_us", host::quantile(time_us, 0.5)}}));
    return;
  }
  fmt::print("{}: {} pairs, median {:.4f} m and {:.3f} deg; {:.1f} % within 0.1 m and 2 deg\n",
             options.matcher, pairs.size(), median_m, median_deg, 100.0 * share);
}

}  // namespace picolo::tool
