// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recorded log as a live drive at its own times: wheel counts as its odometry says a
/// differential drive would have counted, scans when they were taken.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/host/carmen.hpp"
#include "picolo/host/trajectory.hpp"

namespace picolo::test {

inline constexpr double kLogMetresPerCount = 1.5e-4;  // as the simulated vehicle

inline constexpr double kLogTrack_m = 0.5;

/// Numbers over time that do not change their rate at once: cubic between knots, with the mean rate
/// about each of them; constant before the first and after the last.
template <std::size_t N>
class Curve {
 public:
  using Values = std::array<double, N>;
  void add(Timestamp stamp, const Values& values) { knots_.push_back({stamp, values}); }
  [[nodiscard]] bool empty() const { return knots_.empty(); }
  [[nodiscard]] Timestamp end() const { return knots_.back().stamp; }
  [[nodiscard]] Values at(Timestamp stamp) const {
    const auto next =
        std::upper_bound(knots_.begin(), knots_.end(), stamp,
                         [](Timestamp at, const Knot& knot) { return at < knot.stamp; });
    if (next == knots_.begin()) { return next->values; }
    const Knot& before = *(next - 1);
    if (next == knots_.end()) { return before.values; }
    const Values from = rate(next - 1);
    const Values to = rate(next);
    const double length_s = std::max(1e-6, to_seconds_f64(next->stamp - before.stamp));
    const double u = to_seconds_f64(stamp - before.stamp) / length_s;
    Values values{};
    for (std::size_t i = 0; i < N; ++i) {
      const double way = next->values[i] - before.values[i];
      values[i] = before.values[i] + u * u * (3.0 - 2.0 * u) * way +
                  u * (1.0 - u) * length_s * ((1.0 - u) * from[i] - u * to[i]);
    }
    return values;
  }

 private:
  struct Knot {
    Timestamp stamp{};
    Values values{};
  };
  [[nodiscard]] Values rate(std::vector<Knot>::const_iterator knot) const {
    const auto before = knot == knots_.begin() ? knot : knot - 1;
    const auto after = knot + 1 == knots_.end() ? knot : knot + 1;
    const double time_s = std::max(1e-6, to_seconds_f64(after->stamp - before->stamp));
    Values rate{};
    for (std::size_t i = 0; i < N; ++i) {
      rate[i] = (after->values[i] - before->values[i]) / time_s;
    }
    return rate;
  }

  std::vector<Knot> knots_;
};

/// The log on the clock of the replay, which begins a second before its first scan.
class LogTrack {
 public:
  explicit LogTrack(const host::CarmenLog& log) {
    if (log.scans.empty()) {
      read_sweeps(log);
    } else {
      read_scans(log);
    }
  }

  struct Scan {
    Timestamp stamp{};
    Timestamp received{};
    Duration beam_step{};
    std::vector<float> ranges_m;
    std::vector<float> bearings_rad;
    float no_return_m = 30.0F;  ///< from there on nothing came back
  };
  [[nodiscard]] const std::vector<Scan>& scans() const { return scans_; }
  [[nodiscard]] const Pose2d& base_T_lidar() const { return base_T_lidar_; }
  [[nodiscard]] Timestamp end() const { return rolled_.end(); }
  /// How far each wheel has rolled.
  [[nodiscard]] std::array<double, 2> metres_at(Timestamp stamp) const { return rolled_.at(stamp); }

  /// Whose headings, one for each scan of the log, are the gyro's.
  void take_gyro_from(const host::Trajectory& trajectory) {
    double heading = 0.0;
    for (std::size_t k = 0; k < std::min(trajectory.size(), scans_.size()); ++k) {
      const double theta = trajectory[k].pose.theta_rad;
      heading += std::remainder(theta - heading, 2.0 * std::numbers::pi);
      heading_.add(scans_[k].stamp, {heading});
    }
  }
  /// As if its wheels had gone the way of `trajectory`, one pose for each scan of the log.
  void take_wheels_from(const host::Trajectory& trajectory) {
    rolled_ = {};
    metres_ = {};
    for (std::size_t k = 0; k < std::min(trajectory.size(), scans_.size()); ++k) {
      drive_to(trajectory[k].pose, scans_[k].stamp);
    }
  }
  [[nodiscard]] bool has_gyro() const { return !heading_.empty(); }
  [[nodiscard]] double yaw_rate_at(Timestamp stamp) const {
    constexpr Duration kHalf = 5ms;
    const double turn = heading_.at(stamp + kHalf)[0] - heading_.at(stamp - kHalf)[0];
    return turn / to_seconds_f64(2 * kHalf);
  }

 private:
  /// As a differential drive would have counted the way to the next pose of the odometry.
  void drive_to(const Pose2d& odom_T_base, Timestamp stamp) {
    if (rolled_.empty()) { played_ = odom_T_base; }
    const Pose2d way = between(played_, odom_T_base);
    const double half = 0.5 * way.theta_rad;
    const double chord_m = way.x_m * std::cos(half) + way.y_m * std::sin(half);
    const double arc_m = std::abs(half) < 1e-9 ? chord_m : chord_m * half / std::sin(half);
    metres_[0] += arc_m - half * kLogTrack_m;
    metres_[1] += arc_m + half * kLogTrack_m;
    played_ = played_ * exp_se2(Tangent2<double>{arc_m, 0.0, way.theta_rad});
    rolled_.add(stamp, metres_);
  }
  void read_scans(const host::CarmenLog& log) {
    base_T_lidar_ = log.scans.front().base_T_lidar;
    for (const host::LogScan& scan : log.scans) {
      const Timestamp stamp{1s + from_seconds(scan.stamp_s - log.scans.front().stamp_s)};
      drive_to(scan.odom_T_base, stamp);
      const auto limit = static_cast<float>(std::min(30.0, scan.max_range_m.value_or(30.0)));
      scans_.push_back({stamp, stamp, Duration{0}, scan.ranges_m, scan.bearings_rad, limit});
    }
  }
  void read_sweeps(const host::CarmenLog& log) {
    base_T_lidar_ = {0.21, 0.0, std::numbers::pi};  // of the robot that recorded them
    for (const host::LogOdometry& odometry : log.odometry) {
      drive_to(odometry.odom_T_base, Timestamp{from_seconds(odometry.stamp_s)});
    }
    for (const host::LogSweep& sweep : log.sweeps) {
      scans_.push_back({Timestamp{from_seconds(sweep.stamp_s)},
                        Timestamp{from_seconds(sweep.received_s)},
                        from_seconds(sweep.time_increment_s), sweep.ranges_m, sweep.bearings_rad});
    }
  }

  Curve<2> rolled_;
  Curve<1> heading_;
  std::vector<Scan> scans_;
  Pose2d base_T_lidar_{};
  Pose2d played_{};
  std::array<double, 2> metres_{};
};

}  // namespace picolo::test
