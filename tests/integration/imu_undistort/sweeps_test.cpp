// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A real robot that turns on the spot. No recording has both a 2D lidar and an IMU, so the yaw rate
// of the wheels stands in for the gyro: the sums below show the method, not an IMU's quality.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "picolo/localisation/localiser.hpp"
#include "picolo/localisation/profile.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/odometry/iterated_undistortion.hpp"
#include "picolo/undistort/imu_motion.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo {
namespace {

constexpr const char* kLog = "imu/undistort_sweeps_a.txt.gz";
constexpr Pose2f kBaseTLidar{0.21F, 0.0F, 3.14159265F};
constexpr float kMaxRange_m = 12.0F;
constexpr std::size_t kReturns = 400;

struct Odometry {
  Timestamp stamp{};
  Pose2d pose{};
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

struct RecordedSweep {
  std::vector<RangeReturn> returns;
  Timestamp first{};
  Timestamp last{};
  [[nodiscard]] Sweep view() const { return {first, last, 1, returns}; }
};

struct Log {
  std::vector<Odometry> odometry;
  std::vector<RecordedSweep> covered;  // by odometry, from the first return to the last
  std::vector<RecordedSweep> turning;  // of these, at more than 0.3 rad/s
};

Log read_log() {
  Log log;
  std::vector<RecordedSweep> sweeps;
  for (const std::string& line : test::gz_lines(test::data_path(kLog))) {
    if (line.starts_with("ODOM ")) {
      const std::vector<double> v = test::numbers_in(line);
      log.odometry.push_back({Timestamp{from_seconds(v[6])}, {v[0], v[1], v[2]}, v[3], v[4]});
    } else if (line.starts_with("SWEEP ")) {
      const std::vector<double> v = test::numbers_in(line);
      RecordedSweep sweep;
      sweep.first = Timestamp{from_seconds(v[0])};
      const auto n = static_cast<std::size_t>(v[2]);
      for (std::size_t k = 0; k < n; ++k) {
        sweep.returns.push_back({static_cast<float>(v[5 + 2 * k]), static_cast<float>(v[4 + 2 * k]),
                                 static_cast<float>(static_cast<double>(k) * v[1])});
      }
      sweep.last = sweep.first + from_seconds(static_cast<double>(n - 1) * v[1]);
      sweeps.push_back(sweep);
    }
  }
  for (const RecordedSweep& sweep : sweeps) {
    if (sweep.first < log.odometry.front().stamp || sweep.last > log.odometry.back().stamp) {
      continue;
    }
    log.covered.push_back(sweep);
    for (const Odometry& odometry : log.odometry) {
      if (odometry.stamp < sweep.first) { continue; }
      if (std::abs(odometry.yaw_rate_radps) > 0.3) { log.turning.push_back(sweep); }
      break;
    }
  }
  return log;
}

using Cells = std::set<std::pair<int, int>>;

void count(const Pose2d& frame_T_base, const PointsView& points, Cells& cells) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point2<double> p = transform(
        frame_T_base,
        Point2<double>{static_cast<double>(points.x_m[k]), static_cast<double>(points.y_m[k])});
    cells.emplace(static_cast<int>(std::floor(p.x_m / 0.03)),
                  static_cast<int>(std::floor(p.y_m / 0.03)));
  }
}

/// The yaw rate of this log is filtered: against the differences of its own poses it is late by two
/// and a half samples.
constexpr Duration kRateLag = 50ms;

/// The wheels' poses, or their yaw rate alone as a gyro would have it, around one sweep.
enum class Motion { wheels, gyro, prompt_gyro };

void fill(const Log& log, const RecordedSweep& sweep, Motion kind, PoseBufferCore& poses) {
  poses.clear();
  ImuMotion motion;
  for (const Odometry& odometry : log.odometry) {
    if (odometry.stamp < sweep.first - 100ms || odometry.stamp > sweep.last + 100ms) { continue; }
    if (kind != Motion::wheels) {
      const Duration lag = kind == Motion::prompt_gyro ? kRateLag : Duration{0};
      ImuSample sample{.stamp = odometry.stamp - lag};
      sample.rate_radps[2] = static_cast<float>(odometry.yaw_rate_radps);
      ASSERT_EQ(motion.add(sample, poses), Status::ok);
    } else {
      ASSERT_EQ(poses.push({odometry.stamp, odometry.pose}), Status::ok);
    }
  }
}

PointsView undistorted(UndistorterCore& undistorter, const RecordedSweep& sweep,
                       const PoseBufferCore& poses) {
  const UndistortConfig config{.base_T_lidar = kBaseTLidar, .limits = {0.001F, kMaxRange_m}};
  EXPECT_EQ(undistorter.begin(config, sweep.view()), Status::ok);
  EXPECT_EQ(undistorter.step(poses, 10000), Status::ok);
  return undistorter.result().points;
}

class ImuUndistortion : public ::testing::Test {
 protected:
  std::array<float, kReturns> x_m_{};
  std::array<float, kReturns> y_m_{};
  UndistorterCore undistorter_{x_m_, y_m_};
  PoseBuffer<64> storage_;
  PoseBufferCore wheels_ = storage_.core();
  PoseBuffer<64> gyro_storage_;
  PoseBufferCore gyro_ = gyro_storage_.core();
};

TEST_F(ImuUndistortion, GivenTheYawRateAsGyroThenTheTurningSweepsAreAsSharpAsWithWheelPoses) {
  PICOLO_NEED_DATA(kLog);
  const Log log = read_log();
  ASSERT_EQ(log.turning.size(), 275U);
  Cells instant;
  Cells by_wheels;
  Cells by_gyro;
  Cells by_prompt_gyro;
  for (const RecordedSweep& sweep : log.turning) {
    fill(log, sweep, Motion::wheels, wheels_);
    fill(log, sweep, Motion::gyro, gyro_);
    const Pose2d at_end = *wheels_.at(sweep.last);
    count(at_end, undistorted(undistorter_, sweep, wheels_), by_wheels);
    count(at_end, undistorted(undistorter_, sweep, gyro_), by_gyro);
    fill(log, sweep, Motion::prompt_gyro, gyro_);
    count(at_end, undistorted(undistorter_, sweep, gyro_), by_prompt_gyro);
    PoseBuffer<2> still;  // one instant: the pose of the first return holds throughout
    PoseBufferCore frozen = still.core();
    const Pose2d at_start = *wheels_.at(sweep.first);
    ASSERT_EQ(frozen.push({sweep.first - 1ms, at_start}), Status::ok);
    ASSERT_EQ(frozen.push({sweep.last + 1ms, at_start}), Status::ok);
    count(at_start, undistorted(undistorter_, sweep, frozen), instant);
  }
  std::printf(
      "cells of 3 cm: one instant %zu, wheel poses %zu, yaw rate as gyro %zu, its lag taken out "
      "%zu\n",
      instant.size(), by_wheels.size(), by_gyro.size(), by_prompt_gyro.size());
  EXPECT_NEAR(static_cast<double>(instant.size()), 3525.0, 2.0);
  EXPECT_NEAR(static_cast<double>(by_wheels.size()), 1747.0, 10.0);
  EXPECT_LT(by_gyro.size(), 0.6 * static_cast<double>(instant.size()));
  EXPECT_LT(by_prompt_gyro.size(), 1.05 * static_cast<double>(by_wheels.size()));
}

// Door frames that come into view one after the other have dragged the pose by 0.6 m along the
// corridor, in a map that stayed consistent with itself.
TEST_F(ImuUndistortion, GivenTurnsOnTheSpotInACorridorThenTheLocaliserStaysOnIt) {
  PICOLO_NEED_DATA(kLog);
  const Log log = read_log();
  PoseBuffer<2048> storage;
  PoseBufferCore poses = storage.core();
  for (const Odometry& odometry : log.odometry) {
    static_cast<void>(poses.push({odometry.stamp, odometry.pose}));
  }
  auto localiser = std::make_unique<Localiser<SiteProfile>>();
  LocaliserCore& core = localiser->core();
  double worst_m = 0.0;
  for (const RecordedSweep& sweep : log.covered) {
    static_cast<void>(undistorted(undistorter_, sweep, poses));
    const UndistortedSweep& points = undistorter_.result();
    if (core.counters().sweeps == 0) { core.set_pose(points.odom_T_base, points.odom_T_base); }
    ASSERT_EQ(core.process(points, true), Status::ok);
    const Pose2d error = between(points.odom_T_base, core.map_T_base());
    worst_m = std::max(worst_m, std::hypot(error.x_m, error.y_m));
  }
  std::printf("turning on the spot, %zu sweeps: at most %.3f m from where the wheels stand\n",
              log.covered.size(), worst_m);
  EXPECT_EQ(log.covered.size(), 326U);
  EXPECT_EQ(core.counters().rejected, 0U) << "or the pose is that of the wheels";
  EXPECT_LE(worst_m, 0.2);
}

/// Sweep after sweep against the map of those before, the pose carried on from match to match.
struct MapRun {
  Cells cells;
  double residual_m = 0.0;
  int believed = 0;
  int converged = 0;
};

MapRun run_on_map(const Log& log, int max_rounds, double gyro_bias_radps) {
  MapRun run;
  auto map = std::make_unique<RollingMap<640, 640>>();
  map->core().reset(0.0, 0.0);
  IteratedUndistortion<kReturns> iterated{{.max_rounds = max_rounds}};
  PoseBuffer<2048> storage;  // the whole log: an anchor may be seconds old
  PoseBufferCore poses = storage.core();
  MatchAnchor anchor{};
  std::size_t next = 0;
  ImuMotion motion;
  motion.set_bias(static_cast<float>(gyro_bias_radps));
  for (const RecordedSweep& sweep : log.turning) {
    for (; next < log.odometry.size() && log.odometry[next].stamp <= sweep.last + 25ms; ++next) {
      ImuSample sample{.stamp = log.odometry[next].stamp};
      sample.rate_radps[2] = static_cast<float>(log.odometry[next].yaw_rate_radps);
      static_cast<void>(motion.add(sample, poses));
    }
    const GridWindow& window = map->core().window();
    if (!poses.at(anchor.stamp)) { anchor = {sweep.first, to_window(window, {})}; }  // the first
    if (iterated.core().begin({.base_T_lidar = kBaseTLidar, .limits = {0.001F, kMaxRange_m}},
                              sweep.view(), poses, map->core().field(), anchor) != Status::ok) {
      continue;
    }
    while (iterated.core().step(1000) == Status::not_ready) {}
    const IteratedUndistortionReport& report = iterated.core().report();
    const PointsView points = iterated.core().sweep().points;
    anchor = iterated.core().anchor();
    run.believed += report.believed ? 1 : 0;
    run.converged += report.converged ? 1 : 0;
    if (report.believed) { run.residual_m += static_cast<double>(report.match.mean_residual_m); }
    map->core().begin_scan();
    const Pose2f& pose = anchor.window_T_base;
    for (std::size_t k = 0; k < points.size(); ++k) {
      map->core().add_hit(transform(pose, {points.x_m[k], points.y_m[k]}));
    }
    const Point2f lidar = transform(pose, {kBaseTLidar.x_m, kBaseTLidar.y_m});
    for (std::size_t k = 0; k < points.size(); ++k) {
      map->core().add_ray(lidar, transform(pose, {points.x_m[k], points.y_m[k]}), 2);
    }
    static_cast<void>(map->core().repair(1600));
    count(to_map(window, pose), points, run.cells);
  }
  run.residual_m /= run.believed;
  return run;
}

TEST_F(ImuUndistortion, GivenAGyroWithABiasThenIterationSharpensWhatItBlurs) {
  PICOLO_NEED_DATA(kLog);
  const Log log = read_log();
  for (const double bias_radps : {0.0, 0.3}) {
    const MapRun alone = run_on_map(log, 1, bias_radps);
    const MapRun iterated = run_on_map(log, 8, bias_radps);
    std::printf(
        "bias %.1f rad/s: gyro alone %zu cells, residual %.1f mm; iterated %zu cells, residual "
        "%.1f mm, %d of %zu converged\n",
        bias_radps, alone.cells.size(), 1e3 * alone.residual_m, iterated.cells.size(),
        1e3 * iterated.residual_m, iterated.converged, log.turning.size());
    EXPECT_GT(iterated.believed, 260);
    if (bias_radps > 0.0) {
      EXPECT_LT(iterated.cells.size(), 0.95 * static_cast<double>(alone.cells.size()));
      EXPECT_LT(iterated.residual_m, alone.residual_m);
    } else {
      EXPECT_LT(iterated.cells.size(), 1.1 * static_cast<double>(alone.cells.size()));
    }
  }
}

}  // namespace
}  // namespace picolo
