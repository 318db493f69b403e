// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "replay_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

constexpr Duration kSyntheticPeriod = 100ms;

Timestamp at(double seconds_s) {
  return Timestamp{from_seconds(seconds_s)};
}

/// Readings at the scanner's own maximum are its way to say that nothing came back.
RangeLimits limits_of(const host::LogScan& scan, const ReplaySettings& settings) {
  RangeLimits limits{.min_m = settings.min_range_m, .max_m = settings.max_range_m};
  if (scan.max_range_m) {
    const float stated_m = std::nextafter(static_cast<float>(*scan.max_range_m), 0.0F);
    limits.max_m = std::min(limits.max_m, stated_m);
  }
  return limits;
}

std::vector<RangeReturn> returns_of(const std::vector<float>& ranges_m,
                                    const std::vector<float>& bearings_rad, double increment_s) {
  std::vector<RangeReturn> returns;
  returns.reserve(ranges_m.size());
  for (std::size_t k = 0; k < ranges_m.size(); ++k) {
    returns.push_back(
        {ranges_m[k], bearings_rad[k], static_cast<float>(static_cast<double>(k) * increment_s)});
  }
  return returns;
}

/// The order in which a lidar that turns clockwise from its x axis measures, as on the wires: sums
/// over points then run alike, however the log is replayed.
void order_clockwise(std::vector<RangeReturn>& returns) {
  const auto clockwise_rad = [](const RangeReturn& beam) {
    return beam.bearing_rad > 0.0F ? 2.0F * std::numbers::pi_v<float> - beam.bearing_rad
                                   : -beam.bearing_rad;
  };
  std::stable_sort(returns.begin(), returns.end(), [&](const auto& a, const auto& b) {
    return clockwise_rad(a) < clockwise_rad(b);
  });
}

void add_instants(const host::CarmenLog& log, const ReplaySettings& settings, ReplayInput& input) {
  for (const host::LogScan& scan : log.scans) {
    const Timestamp stamp =
        input.synthetic_clock ? Timestamp{kSyntheticPeriod * input.scans.size()} : at(scan.stamp_s);
    const Pose2d mount = settings.base_T_lidar.value_or(scan.base_T_lidar);
    input.scans.push_back({scan.line, scan.stamp_s, stamp, stamp,
                           returns_of(scan.ranges_m, scan.bearings_rad, 0.0),
                           limits_of(scan, settings), to_f32(mount), scan.odom_T_base});
    order_clockwise(input.scans.back().returns);
    input.poses.push_back({stamp, input.use_odometry ? scan.odom_T_base : Pose2d{}});
  }
}

void add_sweeps(const host::CarmenLog& log, const ReplaySettings& settings, ReplayInput& input) {
  for (const host::LogOdometry& odometry : log.odometry) {
    const Timestamp stamp = at(odometry.stamp_s);
    if (input.poses.empty() || stamp > input.poses.back().stamp) {
      input.poses.push_back({stamp, input.use_odometry ? odometry.odom_T_base : Pose2d{}});
    }
  }
  for (const host::LogSweep& sweep : log.sweeps) {
    if (sweep.ranges_m.empty()) { continue; }
    const Timestamp stamp = at(sweep.stamp_s);
    const double length_s = sweep.time_increment_s * static_cast<double>(sweep.ranges_m.size() - 1);
    input.scans.push_back({sweep.line,
                           sweep.stamp_s,
                           stamp,
                           at(sweep.stamp_s + length_s),
                           returns_of(sweep.ranges_m, sweep.bearings_rad, sweep.time_increment_s),
                           {.min_m = settings.min_range_m, .max_m = settings.max_range_m},
                           to_f32(settings.base_T_lidar.value_or(Pose2d{})),
                           {}});
  }
}

}  // namespace

ReplayInput prepare(const host::CarmenLog& log, const ReplaySettings& settings,
                    host::Diagnostics& diagnostics) {
  ReplayInput input;
  input.use_odometry = settings.use_odometry;
  if (log.scans.empty() && (log.sweeps.empty() || log.odometry.empty())) {
    throw host::UserError{
        host::ExitCode::input, log.name,
        "holds no valid scan" + (log.damage.empty() ? std::string{} : ", and " + log.damage),
        "a log has FLASER or ROBOTLASER1 lines, or SWEEP and ODOM lines"};
  }
  if (log.scans.empty()) {
    add_sweeps(log, settings, input);
    return input;
  }
  if (input.use_odometry && log.scans.size() > 1 && odometry_never_moves(log)) {
    diagnostics.warn(log.name, "its odometry never moves; taken as a log without odometry",
                     "give --no-odometry to say so");
    input.use_odometry = false;
  }
  if (!stamps_increase(log)) {
    diagnostics.warn(log.name,
                     "its stamps do not increase; scans are taken in the order of the file, 0.1 s "
                     "apart, and the stamps written are the log's");
    input.synthetic_clock = true;
  }
  add_instants(log, settings, input);
  return input;
}

}  // namespace picolo::tool
