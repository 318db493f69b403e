// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Undistortion against the closed form, over every reference instant and output frame, and the
// faults of textbook code.

#include "picolo/undistort/undistorter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace picolo {
namespace {

constexpr std::size_t kBeams = 360;

/// A vehicle on a circle: the exact pose at any time, and odometry samples of it at a chosen rate.
struct Circle {
  double speed_mps = 0.8;
  double omega_radps = 1.5;
  [[nodiscard]] Pose2d at(double t_s) const {
    const Pose2d motion = exp_se2(Tangent2<double>{speed_mps * t_s, 0.0, omega_radps * t_s});
    return Pose2d{3.0, -2.0, 2.5} * motion;
  }
  void fill(PoseBuffer<256>& poses, int from_ms, int to_ms, int every_ms) const {
    for (int ms = from_ms; ms <= to_ms; ms += every_ms) {
      ASSERT_EQ(poses.push({Timestamp{Duration{ms * 1000}}, at(ms * 1e-3)}), Status::ok);
    }
  }
};

/// What the lidar measures of the wall of points `odom_p(k)`: exact ranges from the true pose at
/// each beam's time.
struct Recorded {
  std::vector<RangeReturn> returns;
  std::vector<Point2<double>> odom_p;
  Sweep sweep;
};

Recorded record(const Circle& circle, const Pose2f& base_T_lidar, double start_s, double duration_s,
                std::size_t beams = kBeams) {
  Recorded recorded;
  for (std::size_t k = 0; k < beams; ++k) {
    const double t_s =
        beams > 1 ? duration_s * static_cast<double>(k) / static_cast<double>(beams - 1) : 0.0;
    const Pose2d odom_T_lidar = circle.at(start_s + t_s) * to_f64(base_T_lidar);
    const double bearing = -3.1 + 6.2 * static_cast<double>(k) / static_cast<double>(beams);
    const double range = 4.0 + std::sin(5.0 * bearing);
    recorded.odom_p.push_back(transform(
        odom_T_lidar, Point2<double>{range * std::cos(bearing), range * std::sin(bearing)}));
    recorded.returns.push_back(
        {static_cast<float>(range), static_cast<float>(bearing), static_cast<float>(t_s)});
  }
  recorded.sweep.stamp = Timestamp{from_seconds(start_s)};
  recorded.sweep.last_stamp = Timestamp{from_seconds(start_s + (beams > 1 ? duration_s : 0.0))};
  recorded.sweep.returns = recorded.returns;
  return recorded;
}

Status run(Undistorter<kBeams>& undistorter, const UndistortConfig& config, const Sweep& sweep,
           const PoseBuffer<256>& poses, std::size_t slice = 1000) {
  Status status = undistorter.begin(config, sweep);
  if (status != Status::ok) { return status; }
  for (int i = 0; i < 1000; ++i) {
    status = undistorter.step(poses.core(), slice);
    if (status != Status::not_ready) { return status; }
  }
  return status;
}

double worst_error(const UndistortedSweep& result, const Recorded& recorded,
                   const Pose2d& odom_T_b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    const Point2<double> p =
        transform(odom_T_b, Point2<double>{static_cast<double>(result.points.x_m[i]),
                                           static_cast<double>(result.points.y_m[i])});
    worst =
        std::max(worst, std::hypot(p.x_m - recorded.odom_p[i].x_m, p.y_m - recorded.odom_p[i].y_m));
  }
  return worst;
}

class UndistorterFrames
    : public ::testing::TestWithParam<std::tuple<SweepReference, SweepFrame, int>> {};

TEST_P(UndistorterFrames, PutsEveryReturnWhereItWasMeasured) {
  const auto [reference, frame, odometry_ms] = GetParam();
  const Circle circle;
  const Pose2f base_T_lidar{0.21F, -0.1F, 3.0F};
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 400, odometry_ms);
  const Recorded recorded = record(circle, base_T_lidar, 0.12, 0.1);
  UndistortConfig config{.base_T_lidar = base_T_lidar, .reference = reference, .frame = frame};
  config.reference_stamp = Timestamp{200ms};

  Undistorter<kBeams> undistorter;
  ASSERT_EQ(run(undistorter, config, recorded.sweep, poses), Status::ok);

  const double reference_s = reference == SweepReference::first_return  ? 0.12
                             : reference == SweepReference::last_return ? 0.22
                                                                        : 0.2;
  Pose2d odom_T_b = circle.at(reference_s);
  const UndistortedSweep& result = undistorter.result();
  EXPECT_NEAR(result.odom_T_base.x_m, odom_T_b.x_m, 1e-3);
  if (frame == SweepFrame::lidar) { odom_T_b = odom_T_b * to_f64(base_T_lidar); }
  ASSERT_EQ(result.points.size(), kBeams);
  // Chord against arc: the lerp over d seconds of odometry errs by v omega d^2 / 8.
  const double chord_m = 0.8 * 1.5 * odometry_ms * 1e-3 * odometry_ms * 1e-3 / 8.0;
  EXPECT_LE(worst_error(result, recorded, odom_T_b), 2.0 * chord_m + 2e-5);
  const Pose2d b_T_first = between(odom_T_b, circle.at(0.12) * to_f64(base_T_lidar));
  EXPECT_NEAR(result.lidar_at_first_m.x_m, b_T_first.x_m, 1e-3);
  EXPECT_NEAR(result.lidar_at_first_m.y_m, b_T_first.y_m, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, UndistorterFrames,
                         ::testing::Combine(::testing::Values(SweepReference::first_return,
                                                              SweepReference::last_return,
                                                              SweepReference::stamp),
                                            ::testing::Values(SweepFrame::base, SweepFrame::lidar),
                                            ::testing::Values(2, 5, 20, 40)));

TEST(Undistorter, SlicesOfAnySizeGiveTheSameBits) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 400, 7);
  const Recorded recorded = record(circle, {}, 0.1, 0.1);
  Undistorter<kBeams> whole;
  Undistorter<kBeams> sliced;
  ASSERT_EQ(run(whole, {}, recorded.sweep, poses), Status::ok);
  for (const std::size_t slice : {1U, 7U, 64U, 359U}) {
    ASSERT_EQ(run(sliced, {}, recorded.sweep, poses, slice), Status::ok);
    for (std::size_t i = 0; i < kBeams; ++i) {
      ASSERT_EQ(whole.result().points.x_m[i], sliced.result().points.x_m[i]);
      ASSERT_EQ(whole.result().points.y_m[i], sliced.result().points.y_m[i]);
    }
  }
}

TEST(Undistorter, WaitsForOdometryInsteadOfGuessing) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 190, 10);  // the sweep ends at 200 ms
  const Recorded recorded = record(circle, {}, 0.1, 0.1);
  Undistorter<kBeams> undistorter;
  ASSERT_EQ(undistorter.begin({}, recorded.sweep), Status::ok);
  EXPECT_EQ(undistorter.step(poses.core(), kBeams), Status::not_ready);
  EXPECT_EQ(undistorter.step(poses.core(), kBeams), Status::not_ready);
  ASSERT_EQ(poses.push({Timestamp{200ms}, circle.at(0.2)}), Status::ok);
  EXPECT_EQ(undistorter.step(poses.core(), kBeams), Status::ok);
  EXPECT_EQ(undistorter.result().points.size(), kBeams);
}

TEST(Undistorter, WaitsForALateReferenceToo) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 200, 10);
  const Recorded recorded = record(circle, {}, 0.1, 0.1);
  const UndistortConfig config{.reference = SweepReference::stamp,
                               .reference_stamp = Timestamp{210ms}};
  Undistorter<kBeams> undistorter;
  ASSERT_EQ(undistorter.begin(config, recorded.sweep), Status::ok);
  EXPECT_EQ(undistorter.step(poses.core(), kBeams), Status::not_ready);
  ASSERT_EQ(poses.push({Timestamp{210ms}, circle.at(0.21)}), Status::ok);
  EXPECT_EQ(undistorter.step(poses.core(), kBeams), Status::ok);
}

TEST(Undistorter, RefusesASweepOlderThanTheBuffer) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 110, 300, 10);
  const Recorded recorded = record(circle, {}, 0.1, 0.1);
  Undistorter<kBeams> undistorter;
  EXPECT_EQ(run(undistorter, {}, recorded.sweep, poses), Status::out_of_range);
}

TEST(Undistorter, InvalidReturnsNeverBecomePoints) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 400, 10);
  Recorded recorded = record(circle, {}, 0.1, 0.1);
  recorded.returns[0].range_m = 0.0F;
  recorded.returns[1].range_m = std::numeric_limits<float>::infinity();
  recorded.returns[2].range_m = std::numeric_limits<float>::quiet_NaN();
  recorded.returns[3].range_m = -2.0F;
  recorded.returns[4].range_m = 30.01F;
  recorded.returns[5].bearing_rad = std::numeric_limits<float>::quiet_NaN();
  recorded.odom_p.erase(recorded.odom_p.begin(), recorded.odom_p.begin() + 6);
  Undistorter<kBeams> undistorter;
  ASSERT_EQ(run(undistorter, {}, recorded.sweep, poses), Status::ok);
  EXPECT_EQ(undistorter.result().invalid_returns, 6U);
  ASSERT_EQ(undistorter.result().points.size(), kBeams - 6);
  EXPECT_LE(worst_error(undistorter.result(), recorded, circle.at(0.2)), 1e-4);
}

TEST(Undistorter, OneReturnDividesByNothing) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 400, 10);
  const Recorded recorded = record(circle, {}, 0.105, 0.1, 1);
  Undistorter<kBeams> undistorter;
  ASSERT_EQ(run(undistorter, {}, recorded.sweep, poses), Status::ok);
  ASSERT_EQ(undistorter.result().points.size(), 1U);
  EXPECT_LE(worst_error(undistorter.result(), recorded, circle.at(0.105)), 1e-4);
}

TEST(Undistorter, RefusesNonsenseWithTheRightStatus) {
  const Circle circle;
  PoseBuffer<256> poses;
  circle.fill(poses, 0, 400, 10);
  const Recorded recorded = record(circle, {}, 0.1, 0.1);
  Undistorter<kBeams> undistorter;
  EXPECT_EQ(undistorter.begin({}, Sweep{}), Status::invalid_argument);
  Sweep backwards = recorded.sweep;
  backwards.last_stamp = backwards.stamp - 1ms;
  EXPECT_EQ(undistorter.begin({}, backwards), Status::invalid_argument);
  Sweep longer = recorded.sweep;
  longer.last_stamp = longer.stamp + 150ms;
  EXPECT_EQ(undistorter.begin({}, longer), Status::invalid_argument);
  EXPECT_EQ(undistorter.begin({.limits = {.min_m = 3.0F, .max_m = 1.0F}}, recorded.sweep),
            Status::invalid_argument);
  EXPECT_EQ(undistorter.begin({.max_segment = 6ms}, recorded.sweep), Status::invalid_argument);
  EXPECT_EQ(undistorter.step(poses.core(), 10), Status::invalid_argument);
  Undistorter<10> small;
  EXPECT_EQ(small.begin({}, recorded.sweep), Status::full);
}

}  // namespace
}  // namespace picolo
