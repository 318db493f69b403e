// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A turning, driving vehicle in a room whose IMU knows the turn (with a bias) and nothing of the
// way: as one instant, by the IMU, and iterated.

#include "picolo/odometry/iterated_undistortion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/undistort/imu_motion.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

using Map = RollingMap<320, 320>;
constexpr int kBeams = 360;
constexpr double kSweep_s = 0.1;

std::unique_ptr<Map> drawn(const std::vector<test::Wall>& walls) {
  auto map = std::make_unique<Map>();
  map->core().reset(0.0, 0.0);
  for (const Pose2d pose : {Pose2d{0, 0, 0}, Pose2d{1, 1, 1}, Pose2d{-1, -0.5, 2}}) {
    const test::Scan scan = test::scan_at(walls, pose, 1440);
    map->core().begin_scan();
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
      map->core().add_hit(
          transform(to_window(map->core().window(), pose), {scan.x_m[k], scan.y_m[k]}));
    }
  }
  return map;
}

struct Drive {
  Pose2d start{-0.4, 0.2, 0.6};
  Tangent2<double> twist{1.0, 0.0, 1.2};
  Pose2f base_T_lidar{0.1F, 0.05F, 0.2F};
  double gyro_bias_radps = 0.0;

  [[nodiscard]] Pose2d at(double t_s) const {
    return start *
           exp_se2(Tangent2<double>{twist.x_m * t_s, twist.y_m * t_s, twist.theta_rad * t_s});
  }
};

struct Recorded {
  std::vector<RangeReturn> returns;
  Sweep sweep;
};

void record(const Drive& drive, const std::vector<test::Wall>& walls, Recorded& recorded) {
  for (int k = 0; k < kBeams; ++k) {
    const double t_s = kSweep_s * k / (kBeams - 1);
    const Pose2d lidar = drive.at(t_s) * to_f64(drive.base_T_lidar);
    const double bearing = -3.1 + 6.2 * k / kBeams;
    const double range = test::cast(walls, lidar.x_m, lidar.y_m, lidar.theta_rad + bearing);
    recorded.returns.push_back(
        {static_cast<float>(range), static_cast<float>(bearing), static_cast<float>(t_s)});
  }
  recorded.sweep = {Timestamp{Duration{1'000'000}}, Timestamp{Duration{1'100'000}}, 1,
                    recorded.returns};
}

/// 200 Hz around the sweep.
void feed_imu(const Drive& drive, float speed_mps, PoseBufferCore& poses) {
  ImuMotion motion;
  motion.set_velocity(speed_mps, 0.0F);
  for (int ms = 990; ms <= 1110; ms += 5) {
    ImuSample sample{.stamp = Timestamp{Duration{ms * 1000}}};
    sample.rate_radps[2] = static_cast<float>(drive.twist.theta_rad + drive.gyro_bias_radps);
    ASSERT_EQ(motion.add(sample, poses), Status::ok);
  }
}

struct Outcome {
  IteratedUndistortionReport report;
  double point_rmse_m = 0.0;  // against where the points truly are in the map
  Pose2d pose_error{};
};

class IteratedUndistortionTest : public ::testing::Test {
 protected:
  std::vector<test::Wall> walls_ = test::furnished_room();
  std::unique_ptr<Map> map_ = drawn(walls_);

  Outcome run(const Drive& drive, int max_rounds, float speed_mps = 0.0F,
              const Pose2d& start_error = {}) {
    Recorded recorded;
    record(drive, walls_, recorded);
    PoseBuffer<64> poses;
    PoseBufferCore imu = poses.core();
    feed_imu(drive, speed_mps, imu);
    IteratedUndistortion<kBeams> iterated{{.max_rounds = max_rounds}};
    const GridWindow& window = map_->core().window();
    EXPECT_EQ(iterated.core().begin(
                  {.base_T_lidar = drive.base_T_lidar}, recorded.sweep, imu, map_->core().field(),
                  {recorded.sweep.stamp, to_window(window, drive.start * start_error)}),
              Status::ok);
    int calls = 0;
    Status status = Status::not_ready;
    while ((status = iterated.core().step(100)) == Status::not_ready) { EXPECT_LT(++calls, 1000); }
    EXPECT_EQ(status, Status::ok);
    Outcome outcome{.report = iterated.core().report()};
    const Pose2d found = to_map(window, outcome.report.match.pose);
    outcome.pose_error = between(drive.at(0.5 * kSweep_s), found);
    const PointsView points = iterated.core().sweep().points;
    EXPECT_EQ(points.size(), static_cast<std::size_t>(kBeams));
    double sum = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Pose2d lidar = drive.at(static_cast<double>(recorded.returns[k].since_sweep_start_s)) *
                           to_f64(drive.base_T_lidar);
      const double bearing = static_cast<double>(recorded.returns[k].bearing_rad);
      const double range = static_cast<double>(recorded.returns[k].range_m);
      const Point2<double> truth =
          transform(lidar, Point2<double>{range * std::cos(bearing), range * std::sin(bearing)});
      const Point2<double> got = transform(
          found,
          Point2<double>{static_cast<double>(points.x_m[k]), static_cast<double>(points.y_m[k])});
      sum += (got.x_m - truth.x_m) * (got.x_m - truth.x_m) +
             (got.y_m - truth.y_m) * (got.y_m - truth.y_m);
    }
    outcome.point_rmse_m = std::sqrt(sum / static_cast<double>(points.size()));
    return outcome;
  }
};

TEST_F(IteratedUndistortionTest, GivenAnImuThatKnowsNoWayThenIterationRecoversIt) {
  for (const Drive& drive : {Drive{}, Drive{.twist = {1.5, 0.0, -0.8}},
                             Drive{.start = {0.5, -0.6, 2.0}, .twist = {-1.0, 0.0, 0.3}},
                             Drive{.twist = {0.8, 0.0, 1.5}, .gyro_bias_radps = 0.15}}) {
    const Outcome by_imu = run(drive, 1);
    const Outcome iterated = run(drive, 8);
    RecordProperty("imu_mm", static_cast<int>(1e3 * by_imu.point_rmse_m));
    RecordProperty("iterated_mm", static_cast<int>(1e3 * iterated.point_rmse_m));
    std::printf(
        "points off by %.1f mm with the IMU alone, %.1f mm iterated; pose %.1f mm -> %.1f mm (%d "
        "rounds)\n",
        1e3 * by_imu.point_rmse_m, 1e3 * iterated.point_rmse_m,
        1e3 * std::hypot(by_imu.pose_error.x_m, by_imu.pose_error.y_m),
        1e3 * std::hypot(iterated.pose_error.x_m, iterated.pose_error.y_m), iterated.report.rounds);
    EXPECT_TRUE(iterated.report.believed);
    EXPECT_LT(iterated.point_rmse_m, 0.5 * by_imu.point_rmse_m);
    EXPECT_LT(iterated.point_rmse_m, 0.02);
    EXPECT_LT(std::hypot(iterated.pose_error.x_m, iterated.pose_error.y_m), 0.02);
    EXPECT_LT(iterated.report.match.mean_residual_m, by_imu.report.match.mean_residual_m);
    EXPECT_NEAR(iterated.report.correction.x_m, drive.twist.x_m * 0.5 * kSweep_s, 0.01);
  }
}

TEST_F(IteratedUndistortionTest, GivenWheelsThatKnowTheWayThenOneRoundIsEnoughAndNothingIsSpread) {
  const Drive drive;
  const Outcome outcome = run(drive, 8, 1.0F);
  EXPECT_TRUE(outcome.report.converged);
  EXPECT_LE(outcome.report.rounds, 4);
  EXPECT_LT(std::hypot(outcome.report.correction.x_m, outcome.report.correction.y_m), 0.015F);
  EXPECT_LT(outcome.point_rmse_m, 0.015);
}

TEST_F(IteratedUndistortionTest, GivenAVehicleAtRestThenItConvergesAtOnce) {
  const Outcome outcome = run({.twist = {0, 0, 0}}, 8);
  EXPECT_TRUE(outcome.report.converged);
  EXPECT_LE(outcome.report.rounds, 4);
  EXPECT_LT(outcome.point_rmse_m, 0.01);
}

TEST_F(IteratedUndistortionTest, GivenAMatchThatFailsThenThePointsAreThoseOfTheImuAlone) {
  const Drive drive;
  Recorded recorded;
  record(drive, walls_, recorded);
  PoseBuffer<64> poses;
  PoseBufferCore imu = poses.core();
  feed_imu(drive, 0.0F, imu);
  Map blank;
  IteratedUndistortion<kBeams> iterated;
  ASSERT_EQ(iterated.core().begin({.base_T_lidar = drive.base_T_lidar}, recorded.sweep, imu,
                                  blank.core().field(), {recorded.sweep.stamp, {8.0F, 8.0F, 0.0F}}),
            Status::ok);
  Status status = Status::not_ready;
  while ((status = iterated.core().step(1000)) == Status::not_ready) {}
  EXPECT_EQ(status, Status::ok);
  EXPECT_FALSE(iterated.core().report().believed);
  EXPECT_EQ(iterated.core().report().correction, Pose2f{});
  EXPECT_EQ(iterated.core().sweep().points.size(), static_cast<std::size_t>(kBeams));
  EXPECT_EQ(iterated.core().step(1), Status::invalid_argument) << "nothing is left to do";
}

TEST_F(IteratedUndistortionTest, GivenACorrectionBeyondItsLimitThenTheMatchIsNotBelieved) {
  const Drive drive;
  Recorded recorded;
  record(drive, walls_, recorded);
  PoseBuffer<64> poses;
  PoseBufferCore imu = poses.core();
  feed_imu(drive, 0.0F, imu);
  IteratedUndistortion<kBeams> iterated{{.max_correction_m = 0.03F}};
  ASSERT_EQ(iterated.core().begin(
                {.base_T_lidar = drive.base_T_lidar}, recorded.sweep, imu, map_->core().field(),
                {recorded.sweep.stamp, to_window(map_->core().window(), drive.start)}),
            Status::ok);
  Status status = Status::not_ready;
  while ((status = iterated.core().step(1000)) == Status::not_ready) {}
  EXPECT_EQ(status, Status::ok);
  EXPECT_FALSE(iterated.core().report().believed);
  EXPECT_EQ(iterated.core().report().correction, Pose2f{});
  // The points were made anew without the correction of the rounds before.
  EXPECT_NEAR(iterated.core().sweep().odom_T_base.x_m, 0.0, 1e-6);
}

TEST_F(IteratedUndistortionTest, GivenPosesThatDoNotCoverTheSweepThenItWaitsOrRefuses) {
  const Drive drive;
  Recorded recorded;
  record(drive, walls_, recorded);
  PoseBuffer<64> poses;
  PoseBufferCore imu = poses.core();
  IteratedUndistortion<kBeams> iterated;
  MatchAnchor anchor{recorded.sweep.stamp, {}};
  const auto begin = [&] {
    return iterated.core().begin({}, recorded.sweep, imu, map_->core().field(), anchor);
  };
  EXPECT_EQ(begin(), Status::not_ready);
  ASSERT_EQ(imu.push({Timestamp{Duration{1'050'000}}, {}}), Status::ok);
  ASSERT_EQ(imu.push({Timestamp{Duration{1'200'000}}, {}}), Status::ok);
  EXPECT_EQ(begin(), Status::out_of_range);
  EXPECT_EQ(iterated.core().step(1), Status::invalid_argument);
  IteratedUndistortion<10> small;
  imu.clear();
  feed_imu(drive, 0.0F, imu);
  EXPECT_EQ(small.core().begin({}, recorded.sweep, imu, map_->core().field(), anchor),
            Status::full);
  anchor.stamp = recorded.sweep.stamp + 50ms;
  EXPECT_EQ(begin(), Status::invalid_argument)
      << "an anchor in the middle leaves nothing to spread";
  anchor.stamp = recorded.sweep.stamp;
  IteratedUndistortion<kBeams> wrong{{.max_rounds = 0}};
  EXPECT_EQ(wrong.core().begin({}, recorded.sweep, imu, map_->core().field(), anchor),
            Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
