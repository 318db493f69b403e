// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "commands/calibrate.hpp"
#include "commands/calibrate_files.hpp"
#include "commands/calibrate_report.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

using Estimator = TimeOffset<101, 4096, 4096>;

/// What the second sensor saw between two of its stamps.
struct Interval {
  double begin_s;
  double end_s;
  double theta_rad;
  double distance_m;  ///< 0 where it sees rotation only
};

/// Wheels and the second sensor in the order of time, as a controller sees them.
class Feed {
 public:
  Feed(const DriveFile& drive, TimeOffsetCore& core) : drive_{drive}, core_{core} {}

  void rotation(double begin_s, double end_s, double theta_rad, double distance_m = 0.0) {
    intervals_.push_back({begin_s, end_s, theta_rad, distance_m});
    while (next_ < drive_.wheels.size() && drive_.wheels[next_].stamp_s <= end_s) {
      static_cast<void>(core_.add_wheels(drive_.wheels[next_]));
      ++next_;
    }
    static_cast<void>(core_.add_rotation(begin_s, end_s, theta_rad));
  }
  [[nodiscard]] const std::vector<Interval>& intervals() const { return intervals_; }
  void rest() {
    for (; next_ < drive_.wheels.size(); ++next_) {
      static_cast<void>(core_.add_wheels(drive_.wheels[next_]));
    }
  }

 private:
  const DriveFile& drive_;
  TimeOffsetCore& core_;
  std::vector<Interval> intervals_;
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
                  step.lidar_motion.theta_rad,
                  std::hypot(step.lidar_motion.x_m, step.lidar_motion.y_m));
  }
}

/// Rotation and way of the wheels over an interval of the second sensor, its stamps moved by the
/// lag.
struct WheelStep {
  double theta_rad;
  double rolled_rad;
};
WheelStep wheel_step(const DriveFile& drive, const Interval& interval, double lag_s,
                     const TimeOffsetReport& report) {
  const WheelAngles a = wheels_at(drive.wheels, interval.begin_s - lag_s);
  const WheelAngles b = wheels_at(drive.wheels, interval.end_s - lag_s);
  const double left = b.left_rad - a.left_rad;
  const double right = b.right_rad - a.right_rad;
  return {report.j21 * left + report.j22 * right +
              report.drift_radps * (interval.end_s - interval.begin_s),
          0.5 * (left + right)};
}

/// Metres a radian of both wheels, from what the lidar travelled; 1 where nothing saw metres.
double metres_a_radian(const DriveFile& drive, const std::vector<Interval>& intervals,
                       const TimeOffsetReport& report) {
  double seen_m = 0.0;
  double rolled_rad = 0.0;
  for (const Interval& interval : intervals) {
    seen_m += interval.distance_m;
    rolled_rad += std::abs(wheel_step(drive, interval, report.offset_s.value, report).rolled_rad);
  }
  return seen_m > 0.0 && rolled_rad > 0.0 ? seen_m / rolled_rad : 1.0;
}

void draw(const DriveFile& drive, const std::vector<Interval>& intervals,
          const TimeOffsetReport& report, bool gyro, const std::string& folder) {
  const double scale_m = metres_a_radian(drive, intervals, report);
  Residuals residuals;
  residuals.title = "rotation seen minus rotation of the wheels, over the rotation seen";
  residuals.reference = gyro ? "gyro" : "lidar";
  if (gyro) { residuals.path_note = "; lengths are angles of the wheels: nothing here saw metres"; }
  residuals.note = "intervals; rad; green: clocks as they are, red: offset taken out";
  host::Trajectory odometry, second, corrected;
  Pose2d a, b, c;
  for (const Interval& interval : intervals) {
    const WheelStep was = wheel_step(drive, interval, 0.0, report);
    const WheelStep is = wheel_step(drive, interval, report.offset_s.value, report);
    residuals.before_m.push_back({interval.theta_rad, interval.theta_rad - was.theta_rad});
    residuals.after_m.push_back({interval.theta_rad, interval.theta_rad - is.theta_rad});
    a = a * Pose2d{scale_m * was.rolled_rad, 0.0, was.theta_rad};
    // The second sensor's heading on the wheels' way: at clocks as they are, its corners come late.
    b = b * Pose2d{scale_m * was.rolled_rad, 0.0, interval.theta_rad};
    c = c * Pose2d{scale_m * is.rolled_rad, 0.0, is.theta_rad};
    odometry.push_back({interval.end_s, a});
    second.push_back({interval.end_s, b});
    corrected.push_back({interval.end_s, c});
  }
  draw_calibration(folder, gyro ? "Clock of the gyro" : "Clock of the lidar", residuals, odometry,
                   second, corrected);
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
  draw(drive, feed.intervals(), report, gyro, options.common.out);
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
