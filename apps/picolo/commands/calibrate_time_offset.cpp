// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

using Estimator = TimeOffset<101, 4096, 4096>;

/// Wheels and the second sensor in the order of time, as a controller sees them.
class Feed {
 public:
  Feed(const DriveFile& drive, TimeOffsetCore& core) : drive_{drive}, core_{core} {}

  void rotation(double begin_s, double end_s, double theta_rad) {
    while (next_ < drive_.wheels.size() && drive_.wheels[next_].stamp_s <= end_s) {
      static_cast<void>(core_.add_wheels(drive_.wheels[next_]));
      ++next_;
    }
    static_cast<void>(core_.add_rotation(begin_s, end_s, theta_rad));
  }
  void rest() {
    for (; next_ < drive_.wheels.size(); ++next_) {
      static_cast<void>(core_.add_wheels(drive_.wheels[next_]));
    }
  }

 private:
  const DriveFile& drive_;
  TimeOffsetCore& core_;
  std::size_t next_ = 0;
};

/// Rates cover the interval that ends at their stamp; five make one interval, longer than a gyro's
/// noise.
void feed_gyro(const DriveFile& drive, Feed& feed) {
  double theta = 0.0;
  double begin_s = drive.gyro.front().stamp_s;
  for (std::size_t k = 1; k < drive.gyro.size(); ++k) {
    theta += drive.gyro[k].rate_radps * (drive.gyro[k].stamp_s - drive.gyro[k - 1].stamp_s);
    if (k % 5 != 0) { continue; }
    feed.rotation(begin_s, drive.gyro[k].stamp_s, theta);
    begin_s = drive.gyro[k].stamp_s;
    theta = 0.0;
  }
}

void feed_scans(const DriveFile& drive, Feed& feed) {
  DriveFile blind = drive;  // the match must not learn the odometry's clock from its start
  for (PointScan& scan : blind.scans) { scan.has_odometry = false; }
  for (const ScanStep& step : match_scans(blind, {})) {
    if (!step.converged) { continue; }
    feed.rotation(drive.scans[step.scan - 1].stamp_s, drive.scans[step.scan].stamp_s,
                  step.lidar_motion.theta_rad);
  }
}

}  // namespace

ExitCode calibrate_time_offset_command(const CalibrateOptions& options) {
  host::Diagnostics diagnostics;
  const DriveFile drive = read_drive(options.file, options.ticks_per_turn, diagnostics);
  if (drive.wheels.size() < 2 || (drive.scans.size() < 2 && drive.gyro.size() < 2)) {
    throw host::UserError{ExitCode::input, drive.name,
                          "needs wheel counters and a second sensor with its own stamps",
                          "give a log with TICKS or ENC lines, and IMU lines or scans"};
  }
  const bool gyro = drive.gyro.size() >= 2;
  const auto estimator = std::make_unique<Estimator>(
      TimeOffsetConfig{.max_offset_s = options.max_offset_s,
                       .parameter = gyro ? Parameter::gyro_offset : Parameter::time_offset});
  Feed feed{drive, estimator->core()};
  if (gyro) {
    feed_gyro(drive, feed);
  } else {
    feed_scans(drive, feed);
  }
  feed.rest();
  TimeOffsetReport report;
  static_cast<void>(estimator->core().solve(report));
  print_calibration({{"offset", to_json(report.offset_s)},
                     {"sensor", gyro ? "gyro" : "lidar"},
                     {"explained", report.explained},
                     {"noise_rad", report.noise_rad},
                     {"J21", report.j21},
                     {"J22", report.j22},
                     {"samples_used", report.intervals},
                     {"samples_rejected", report.rejected},
                     {"refused", to_json(report.refusal)}},
                    options.common.json, options.common.out);
  return end_of_calibration(report.refusal, drive.name, drive.damage);
}

}  // namespace picolo::tool
