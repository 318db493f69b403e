// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/carmen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "fields.hpp"
#include "picolo/core/time.hpp"

namespace picolo::host {
namespace {

constexpr double kPi = std::numbers::pi;

Pose2d pose_at(const Fields& fields, std::size_t index, const char* what) {
  return {fields.number(index, what), fields.number(index + 1, what),
          fields.number(index + 2, what)};
}

std::vector<float> ranges_at(const Fields& fields, std::size_t index, std::size_t count) {
  std::vector<float> ranges_m(count);
  for (std::size_t i = 0; i < count; ++i) {
    ranges_m[i] = static_cast<float>(fields.number(index + i, "range", true));
  }
  return ranges_m;
}

std::vector<float> bearings(std::size_t count, double start_rad, double step_rad) {
  std::vector<float> bearings_rad(count);
  for (std::size_t i = 0; i < count; ++i) {
    bearings_rad[i] = static_cast<float>(start_rad + static_cast<double>(i) * step_rad);
  }
  return bearings_rad;
}

/// SICK scanners leave out the beam at +90 deg in the 180 and 360 beam modes.
double flaser_step_rad(std::size_t count) {
  if (count == 180 || count == 360) { return kPi / static_cast<double>(count); }
  return count > 1 ? kPi / static_cast<double>(count - 1) : 0.0;
}

// FLASER n r*n x y theta odom_x odom_y odom_theta stamp host stamp
LogScan parse_flaser(const Fields& fields) {
  const std::size_t beams = fields.count(1, "number of ranges");
  fields.expect_size(beams + 11, fmt::format("FLASER with {} ranges", beams).c_str());
  LogScan scan;
  scan.ranges_m = ranges_at(fields, 2, beams);
  scan.bearings_rad = bearings(beams, -kPi / 2.0, flaser_step_rad(beams));
  scan.odom_T_base = pose_at(fields, beams + 5, "odometry pose");
  scan.stamp_s = fields.number(beams + 8, "stamp");
  scan.has_odometry = true;
  return scan;
}

// ROBOTLASER1 type start fov res max_range accuracy remission n r*n n_rem rem*n_rem laser(x y
// theta) robot(x y theta) tv rv forward side turn stamp host logger_stamp
LogScan parse_robotlaser(const Fields& fields) {
  const std::size_t beams = fields.count(8, "number of ranges");
  const std::size_t remissions = fields.count(9 + beams, "number of remissions");
  const std::size_t tail = 10 + beams + remissions;
  fields.expect_size(
      tail + 14,
      fmt::format("ROBOTLASER1 with {} ranges and {} remissions", beams, remissions).c_str());
  const double resolution_rad = fields.number(4, "angular resolution");
  const double max_range_m = fields.number(5, "maximum range");
  if (!(resolution_rad > 0.0)) { throw BadLine{"angular resolution (field 5) is not positive"}; }
  LogScan scan;
  scan.ranges_m = ranges_at(fields, 9, beams);
  scan.bearings_rad = bearings(beams, fields.number(2, "start angle"), resolution_rad);
  if (max_range_m > 0.0) { scan.max_range_m = max_range_m; }
  const Pose2d odom_T_lidar = pose_at(fields, tail, "laser pose");
  scan.odom_T_base = pose_at(fields, tail + 3, "robot pose");
  scan.base_T_lidar = between(scan.odom_T_base, odom_T_lidar);
  scan.stamp_s = fields.number(tail + 11, "stamp");
  scan.has_odometry = true;
  return scan;
}

// ODOM x y theta tv rv accel stamp host stamp
LogOdometry parse_odom(const Fields& fields) {
  fields.expect_size(10, "ODOM");
  LogOdometry odometry;
  odometry.odom_T_base = pose_at(fields, 1, "odometry pose");
  odometry.speed_mps = fields.number(4, "speed");
  odometry.yaw_rate_radps = fields.number(5, "yaw rate");
  odometry.stamp_s = fields.number(7, "stamp");
  return odometry;
}

// SWEEP t time_increment n t_received (angle range)*n
LogSweep parse_sweep(const Fields& fields) {
  const std::size_t beams = fields.count(3, "number of beams");
  fields.expect_size(5 + 2 * beams, fmt::format("SWEEP with {} beams", beams).c_str());
  LogSweep sweep;
  sweep.stamp_s = fields.number(1, "stamp");
  sweep.time_increment_s = fields.number(2, "time increment");
  sweep.received_s = fields.number(4, "time of reception");
  if (sweep.time_increment_s < 0.0) {
    throw BadLine{"time increment (field 3) is negative: beams must come in the order of time"};
  }
  for (std::size_t i = 0; i < beams; ++i) {
    sweep.bearings_rad.push_back(static_cast<float>(fields.number(5 + 2 * i, "angle")));
    sweep.ranges_m.push_back(static_cast<float>(fields.number(6 + 2 * i, "range", true)));
  }
  return sweep;
}

template <typename Record>
void append(std::vector<Record>& records, Record record, std::size_t line) {
  record.line = line;
  records.push_back(std::move(record));
}

void parse_line(std::string_view line, std::size_t number, CarmenLog& log) {
  const std::string_view keyword = line.substr(0, line.find_first_of(" \t"));
  if (keyword == "FLASER") {
    append(log.scans, parse_flaser(Fields{line}), number);
  } else if (keyword == "ROBOTLASER1") {
    append(log.scans, parse_robotlaser(Fields{line}), number);
  } else if (keyword == "ODOM") {
    append(log.odometry, parse_odom(Fields{line}), number);
  } else if (keyword == "SWEEP") {
    append(log.sweeps, parse_sweep(Fields{line}), number);
  }
}

}  // namespace

CarmenLog read_carmen(LineReader& reader, Diagnostics& diagnostics) {
  CarmenLog log;
  log.name = reader.name();
  std::string_view line;
  while (reader.next(line)) {
    try {
      parse_line(line, reader.line_number(), log);
    } catch (const BadLine& bad) {
      diagnostics.skipped_line(log.name, reader.line_number(), bad.cause);
    }
  }
  diagnostics.end_of_file(log.name);
  log.damage = reader.damage();
  return log;
}

bool odometry_never_moves(const CarmenLog& log) {
  return std::all_of(log.scans.begin(), log.scans.end(), [&log](const LogScan& scan) {
    return scan.odom_T_base == log.scans.front().odom_T_base;
  });
}

bool stamps_increase(const CarmenLog& log) {
  return std::adjacent_find(log.scans.begin(), log.scans.end(),
                            [](const LogScan& before, const LogScan& after) {
                              return from_seconds(after.stamp_s) <= from_seconds(before.stamp_s);
                            }) == log.scans.end();
}

}  // namespace picolo::host
