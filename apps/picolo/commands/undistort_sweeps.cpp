// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands/undistort_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "picolo/host/progress.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kMostBeams = 8192;

/// Feeds odometry and sweeps as a controller receives them: a sweep waits until odometry covers it.
class SweepPlayer {
 public:
  SweepPlayer(const host::CarmenLog& log, const UndistortSettings& settings)
      : log_{log}, settings_{settings} {
    config_.base_T_lidar = to_f32(settings.base_T_lidar);
    config_.limits = {.min_m = std::numeric_limits<float>::min(),
                      .max_m = static_cast<float>(settings.max_range_m)};
  }

  UndistortResult run() {
    host::Progress progress{"undistort", log_.sweeps.size()};
    std::size_t next_odometry = 0;
    for (std::size_t i = 0; i < log_.sweeps.size(); ++i) {
      const host::LogSweep& sweep = log_.sweeps[i];
      while (next_odometry < log_.odometry.size() && !covered(sweep)) {
        add(log_.odometry[next_odometry]);
        ++next_odometry;
      }
      take(sweep);
      progress.at(i + 1);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] static Timestamp stamp_of(const host::LogSweep& sweep, std::size_t beam) {
    return Timestamp{
        from_seconds(sweep.stamp_s + static_cast<double>(beam) * sweep.time_increment_s)};
  }

  [[nodiscard]] bool covered(const host::LogSweep& sweep) const {
    return poses_.size() > 0 && !sweep.ranges_m.empty() &&
           poses_.core().newest().stamp >= stamp_of(sweep, sweep.ranges_m.size() - 1);
  }

  void add(const host::LogOdometry& record) {
    if (is_ok(poses_.push({Timestamp{from_seconds(record.stamp_s)}, record.odom_T_base}))) {
      result_.odometry.push_back({record.stamp_s, record.odom_T_base});
      yaw_rates_radps_.push_back(record.yaw_rate_radps);
    }
  }

  [[nodiscard]] bool turns(const host::LogSweep& sweep) const {
    const auto record = std::lower_bound(
        result_.odometry.begin(), result_.odometry.end(), sweep.stamp_s,
        [](const host::TrajectoryPose& pose, double stamp_s) { return pose.stamp_s < stamp_s; });
    const auto index = static_cast<std::size_t>(record - result_.odometry.begin());
    return index < yaw_rates_radps_.size() &&
           std::abs(yaw_rates_radps_[index]) > settings_.min_yaw_rate_radps;
  }

  void take(const host::LogSweep& record) {
    returns_.clear();
    for (std::size_t k = 0; k < record.ranges_m.size(); ++k) {
      returns_.push_back({record.ranges_m[k], record.bearings_rad[k],
                          static_cast<float>(static_cast<double>(k) * record.time_increment_s)});
    }
    if (!undistort(record)) {
      ++result_.sweeps_uncovered;
    } else if (!turns(record)) {
      ++result_.sweeps_slow;
    } else {
      ++result_.sweeps_counted;
      count_cells();
    }
  }

  bool undistort(const host::LogSweep& record) {
    if (returns_.empty() || returns_.size() > kMostBeams) { return false; }
    const Sweep sweep{stamp_of(record, 0), stamp_of(record, returns_.size() - 1), 0, returns_};
    const Result<Pose2d> at_start = poses_.at(sweep.stamp);
    odom_T_base_at_start_ = at_start.value_or({});
    return at_start && is_ok(undistorter_.begin(config_, sweep)) &&
           is_ok(undistorter_.step(poses_.core(), kMostBeams));
  }

  void count_cells() {
    const Pose2d odom_T_lidar = odom_T_base_at_start_ * settings_.base_T_lidar;
    for (const RangeReturn& beam : returns_) {
      if (!config_.limits.contains(beam.range_m)) { continue; }
      const auto range_m = static_cast<double>(beam.range_m);
      const auto bearing_rad = static_cast<double>(beam.bearing_rad);
      add_cell(result_.before, odom_T_lidar,
               {range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad)});
    }
    const UndistortedSweep& after = undistorter_.result();
    for (std::size_t k = 0; k < after.points.size(); ++k) {
      add_cell(
          result_.after, after.odom_T_base,
          {static_cast<double>(after.points.x_m[k]), static_cast<double>(after.points.y_m[k])});
    }
    result_.returns_counted += after.points.size();
  }

  void add_cell(Cells& cells, const Pose2d& odom_T_frame, const Point2<double>& frame_p) const {
    const Point2<double> point = transform(odom_T_frame, frame_p);
    cells.emplace(static_cast<std::int64_t>(std::floor(point.x_m / settings_.cell_m)),
                  static_cast<std::int64_t>(std::floor(point.y_m / settings_.cell_m)));
  }

  const host::CarmenLog& log_;
  UndistortSettings settings_;
  UndistortConfig config_{};
  PoseBuffer<256> poses_;
  Undistorter<kMostBeams> undistorter_;
  std::vector<RangeReturn> returns_;
  Pose2d odom_T_base_at_start_{};
  std::vector<double> yaw_rates_radps_;  // beside result_.odometry
  UndistortResult result_;
};

}  // namespace

UndistortResult undistort_sweeps(const host::CarmenLog& log, const UndistortSettings& settings) {
  return SweepPlayer{log, settings}.run();
}

}  // namespace picolo::tool
