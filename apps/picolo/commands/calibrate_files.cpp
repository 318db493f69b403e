// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands/calibrate_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>

#include "picolo/host/carmen.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/line_reader.hpp"
#include "picolo/host/progress.hpp"
#include "picolo/matching/plicp.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kMostBeams = 4096;
constexpr double kNoReturn_m = 30.0;

/// The numbers of a line from `at` on; false at the first thing that is none.
bool numbers(std::string_view line, std::vector<double>& values) {
  values.clear();
  const char* at = line.data();
  const char* end = at + line.size();
  for (;;) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == ',' || *at == '\r')) { ++at; }
    if (at == end) { return true; }
    if (*at == '+') { ++at; }
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value)) { return false; }
    values.push_back(value);
    at = next;
  }
}

void add_point(PointScan& scan, double range_m, double bearing_rad) {
  if (!(range_m > 0.05) || range_m > kNoReturn_m) { return; }
  scan.x_m.push_back(static_cast<float>(range_m * std::cos(bearing_rad)));
  scan.y_m.push_back(static_cast<float>(range_m * std::sin(bearing_rad)));
}

class DriveReader {
 public:
  DriveReader(double ticks_per_turn, DriveFile& drive)
      : scale_{ticks_per_turn > 0.0 ? 2.0 * std::numbers::pi / ticks_per_turn : 1.0},
        drive_{drive} {}

  /// False when the line's keyword is known and its numbers are not good.
  bool take(std::string_view line) {
    const auto rest = [&](std::size_t keyword) { return numbers(line.substr(keyword), values_); };
    if (line.starts_with("TICKS ")) {
      return rest(6) && values_.size() >= 3 && wheels(values_[0], values_[1], values_[2]);
    }
    if (line.starts_with("ENC ")) {
      if (!rest(4) || values_.size() < 5) { return false; }
      right_ += 0.5 * (values_[1] + values_[3]);
      left_ += 0.5 * (values_[2] + values_[4]);
      return wheels(values_[0], left_, right_);
    }
    if (line.starts_with("IMU ")) {
      if (!rest(4) || values_.size() < 4) { return false; }
      drive_.gyro.push_back({values_[0], values_[3]});
      return true;
    }
    if (line.starts_with("REFMM ")) {
      if (!rest(6) || values_.size() < 3) { return false; }
      drive_.track.push_back({values_[0], 1e-3 * values_[1], 1e-3 * values_[2]});
      return true;
    }
    if (line.starts_with("SCANMM ")) { return rest(7) && scan_mm(); }
    if (line.starts_with("FLASER ") || line.starts_with("ROBOTLASER1 ")) {
      carmen = true;
      return true;
    }
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0])) != 0) {
      return true;
    }
    if (!numbers(line, values_)) { return false; }
    if (values_.size() >= 6) { drive_.pairs.push_back(values_); }
    return values_.size() >= 6;
  }

  bool carmen = false;

 private:
  /// A counter that is stored twice with one stamp is one reading.
  bool wheels(double stamp_s, double left, double right) {
    if (drive_.wheels.empty() || stamp_s > drive_.wheels.back().stamp_s) {
      drive_.wheels.push_back({stamp_s, scale_ * left, scale_ * right});
    }
    return true;
  }

  bool scan_mm() {
    if (values_.size() < 2 || values_.size() - 2 < static_cast<std::size_t>(values_[1])) {
      return false;
    }
    PointScan scan;
    scan.stamp_s = values_[0];
    const std::size_t beams = values_.size() - 2;
    for (std::size_t k = 0; k < beams; ++k) {
      const double middle = 0.5 * static_cast<double>(beams);
      add_point(scan, 1e-3 * values_[2 + k], (static_cast<double>(k) - middle) * 0.006135923151543);
    }
    drive_.scans.push_back(scan);
    return true;
  }

  double scale_;
  DriveFile& drive_;
  double left_ = 0.0;
  double right_ = 0.0;
  std::vector<double> values_;
};

void add_carmen_scans(const std::string& path, DriveFile& drive, host::Diagnostics& diagnostics) {
  host::LineReader reader{path};
  for (const host::LogScan& record : read_carmen(reader, diagnostics).scans) {
    PointScan scan;
    scan.stamp_s = record.stamp_s;
    scan.odom_T_base = record.odom_T_base;
    scan.has_odometry = record.has_odometry;
    const double limit = record.max_range_m.value_or(kNoReturn_m) * 0.98;
    for (std::size_t k = 0; k < record.ranges_m.size(); ++k) {
      const auto range = static_cast<double>(record.ranges_m[k]);
      if (range < limit) { add_point(scan, range, static_cast<double>(record.bearings_rad[k])); }
    }
    drive.scans.push_back(scan);
  }
}

}  // namespace

NumberFile read_numbers(const std::string& path, std::size_t columns,
                        host::Diagnostics& diagnostics) {
  host::LineReader reader{path};
  NumberFile file{.name = reader.name(), .rows = {}, .damage = {}};
  std::string_view line;
  std::vector<double> values;
  while (reader.next(line)) {
    if (line.empty() || line[0] == '#') { continue; }
    if (numbers(line, values) && values.size() >= columns) {
      file.rows.push_back(values);
    } else {
      diagnostics.skipped_line(file.name, reader.line_number(),
                               fmt::format("is not a row of {} numbers", columns));
    }
  }
  diagnostics.end_of_file(file.name);
  file.damage = reader.damage();
  if (file.rows.empty()) {
    throw host::UserError{host::ExitCode::input, file.name,
                          fmt::format("holds no row of {} numbers", columns),
                          "see 'picolo calibrate --help' for the formats"};
  }
  return file;
}

DriveFile read_drive(const std::string& path, double ticks_per_turn,
                     host::Diagnostics& diagnostics) {
  host::LineReader reader{path};
  DriveFile drive;
  drive.name = reader.name();
  DriveReader lines{ticks_per_turn, drive};
  std::string_view line;
  while (reader.next(line)) {
    if (!lines.take(line)) {
      diagnostics.skipped_line(drive.name, reader.line_number(), "has numbers missing");
    }
  }
  diagnostics.end_of_file(drive.name);
  drive.damage = reader.damage();
  if (lines.carmen) { add_carmen_scans(path, drive, diagnostics); }
  if (drive.wheels.empty() && drive.scans.empty() && drive.pairs.empty()) {
    throw host::UserError{
        host::ExitCode::input, drive.name,
        "holds no TICKS, ENC, SCANMM, FLASER or ROBOTLASER1 record and no row of six numbers",
        "see 'picolo calibrate --help' for the formats"};
  }
  return drive;
}

std::vector<ScanStep> match_scans(const DriveFile& drive, const Pose2d& base_T_lidar) {
  std::vector<ScanStep> steps;
  const auto matcher = std::make_unique<PlIcpMatcher<kMostBeams>>();
  host::Progress progress{"matching", drive.scans.size()};
  Pose2f guess{};
  for (std::size_t k = 1; k < drive.scans.size(); ++k) {
    const PointScan& before = drive.scans[k - 1];
    const PointScan& now = drive.scans[k];
    if (before.has_odometry && now.has_odometry) {
      guess = to_f32(inverse(base_T_lidar) * between(before.odom_T_base, now.odom_T_base) *
                     base_T_lidar);
    }
    const MatchReport report =
        matcher->match({before.x_m, before.y_m}, {.points = {now.x_m, now.y_m}, .start = guess});
    const bool converged = report.outcome == MatchOutcome::converged;
    steps.push_back({k, to_f64(report.pose), converged});
    guess = converged ? report.pose : Pose2f{};
    progress.at(k + 1);
  }
  return steps;
}

WheelAngles wheels_at(const std::vector<WheelAngles>& wheels, double stamp_s) {
  const auto after =
      std::upper_bound(wheels.begin(), wheels.end(), stamp_s,
                       [](double stamp, const WheelAngles& w) { return stamp < w.stamp_s; });
  if (after == wheels.begin()) { return wheels.front(); }
  if (after == wheels.end()) { return wheels.back(); }
  const WheelAngles& a = *(after - 1);
  const double share = (stamp_s - a.stamp_s) / (after->stamp_s - a.stamp_s);
  return {stamp_s, a.left_rad + share * (after->left_rad - a.left_rad),
          a.right_rad + share * (after->right_rad - a.right_rad)};
}

}  // namespace picolo::tool
