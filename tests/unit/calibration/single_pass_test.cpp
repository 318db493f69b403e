// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Single-pass estimators against the batch procedures on every recording, and against the truth on
// simulated drives.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "calib_files.hpp"
#include "picolo/calibration/extrinsic_calibration.hpp"
#include "picolo/calibration/joint_batch.hpp"
#include "picolo/calibration/joint_streaming.hpp"
#include "picolo/calibration/linear_calibration.hpp"
#include "picolo/calibration/wheel_streaming.hpp"
#include "picolo/geometry/angle.hpp"
#include "simulated_drive.hpp"

namespace picolo {
namespace {

std::array<double, 6> values(const DriveParameters& d) {
  return {d.radius_left_m,    d.radius_right_m,   d.track_m,
          d.base_T_lidar.x_m, d.base_T_lidar.y_m, d.base_T_lidar.theta_rad};
}

JointReport streamed(const std::vector<MotionSample>& samples,
                     const JointStreamingConfig& config = {}) {
  JointStreaming streaming{config};
  for (const MotionSample& sample : samples) { EXPECT_EQ(streaming.add(sample), Status::ok); }
  JointReport report;
  static_cast<void>(streaming.solve(report));
  return report;
}

struct Case {
  const char* name;
  int third;
};

class SinglePass : public ::testing::TestWithParam<Case> {};

TEST_P(SinglePass, AgreesWithBatchWithinThreeTenthsOfItsDeviation) {
  PICOLO_NEED_DATA("calib/censi_l90.tuples.txt.gz");
  const std::vector<MotionSample> samples = test::censi_samples(GetParam().name, GetParam().third);
  SpanSource<MotionSample> source{samples};
  JointReport batch;
  ASSERT_EQ(calibrate_joint(source, {}, batch), Status::ok);
  const JointReport single = streamed(samples);
  const auto a = values(batch.drive);
  const auto b = values(single.drive);
  for (std::size_t k = 0; k < 6; ++k) {
    const double difference = k == 5 ? wrap_angle(b[k] - a[k]) : b[k] - a[k];
    EXPECT_LT(std::abs(difference), 0.3 * std::sqrt(batch.covariance[7 * k])) << "parameter " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Censi, SinglePass,
                         ::testing::Values(Case{"censi_l90", -1}, Case{"censi_l90", 0},
                                           Case{"censi_l90", 1}, Case{"censi_l90", 2},
                                           Case{"censi_lmov", -1}, Case{"censi_lmov", 0},
                                           Case{"censi_lmov", 1}, Case{"censi_lmov", 2}));

TEST(WheelStreaming, AgreesWithBatchOnEveryPrefix) {
  PICOLO_NEED_DATA("calib/seed_odom.txt.gz");
  const std::vector<WheelRates> rates = test::seed_rates();
  const std::vector<ScanMotion> scans = test::seed_scans();
  for (const std::uint64_t limit : {100U, 1000U, 5000U, 0U}) {
    SpanSource<WheelRates> rate_source{rates};
    SpanSource<ScanMotion> scan_source{scans};
    WheelReport batch;
    ASSERT_EQ(calibrate_wheels(rate_source, scan_source, {.limit = limit}, batch), Status::ok);
    WheelWalk walk{rate_source, scan_source};
    walk.rewind(limit);
    WheelStreaming streaming;
    WheelStretch stretch;
    ScanMotion scan;
    while (walk.next(stretch, scan)) { streaming.add(stretch, scan); }
    WheelReport single;
    ASSERT_EQ(streaming.solve(single), Status::ok);
    EXPECT_NEAR(single.j21.value, batch.j21.value, 0.3 * batch.j21.std);
    EXPECT_NEAR(single.j22.value, batch.j22.value, 0.3 * batch.j22.std);
    EXPECT_NEAR(single.track_m.value, batch.track_m.value, 0.3 * batch.track_m.std);
    EXPECT_NEAR(single.radius_left_m.value, batch.radius_left_m.value,
                0.3 * batch.radius_left_m.std);
    EXPECT_NEAR(single.radius_right_m.value, batch.radius_right_m.value,
                0.3 * batch.radius_right_m.std);
  }
}

TEST(JointStreaming, SimulatedDrivesReachTheAccuracyAskedFor) {
  const auto t = values(test::truth());
  const double limits[6] = {1e-3 * t[0], 1e-3 * t[1], 1e-3 * t[2],
                            0.002,       0.002,       0.1 * 3.14159265 / 180.0};
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const JointReport report = streamed(test::drive(
        test::truth(), test::sufficient_legs(seed, 60.0), {0.001, 0.0005, 0.0005}, seed));
    EXPECT_FALSE(report.refusal) << to_string(report.refusal.reason);
    const auto found = values(report.drive);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(found[k], t[k], limits[k])
          << "parameter " << k << " std " << std::sqrt(report.covariance[7 * k]);
    }
  }
}

TEST(JointStreaming, NinetyFivePercentIntervalsCoverTheTruth) {
  const auto t = values(test::truth());
  std::array<int, 6> covered{};
  constexpr int kDrives = 1000;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const JointReport report = streamed(
        test::drive(test::truth(), test::sufficient_legs(seed), {0.002, 0.002, 0.0}, 1000 + seed));
    const auto found = values(report.drive);
    for (std::size_t k = 0; k < 6; ++k) {
      if (std::abs(found[k] - t[k]) < 1.96 * std::sqrt(report.covariance[7 * k])) { ++covered[k]; }
    }
  }
  int sum = 0;
  std::printf("covered of %d: %d %d %d %d %d %d\n", kDrives, covered[0], covered[1], covered[2],
              covered[3], covered[4], covered[5]);
  for (const int count : covered) {
    sum += count;
    RecordProperty("covered", count);
    EXPECT_GE(count, kDrives * 92 / 100);
    EXPECT_LE(count, kDrives * 98 / 100);
  }
  EXPECT_GE(sum, 6 * kDrives * 93 / 100);
  EXPECT_LE(sum, 6 * kDrives * 97 / 100);
}

TEST(JointStreaming, GrossOutliersDoNotMoveTheSolution) {
  auto samples = test::drive(test::truth(), test::sufficient_legs(5, 10.0), {0.001, 0.001, 0.0}, 5);
  Random random{9};
  for (MotionSample& sample : samples) {
    if (random.below(20) == 0) {
      sample.lidar_motion.x_m += 0.1 * random.gaussian();
      sample.lidar_motion.theta_rad += 0.1 * random.gaussian();
    }
  }
  const JointReport report = streamed(samples);
  const auto t = values(test::truth());
  const auto found = values(report.drive);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(found[k], t[k], 5.0 * std::sqrt(report.covariance[7 * k]));
  }
  EXPECT_LT(report.used, samples.size() - samples.size() / 40);
}

TEST(JointStreaming, WhateverTheDriveBeginsWith) {
  for (const test::Leg& first :
       {test::Leg{5, 5, 30}, test::Leg{-2, 2, 30}, test::Leg{4, 6, 30}, test::Leg{0, 0, 30}}) {
    std::vector<test::Leg> legs = test::sufficient_legs(7, 10.0);
    legs.insert(legs.begin(), first);
    const JointReport report =
        streamed(test::drive(test::truth(), legs, {0.001, 0.001, 0.0005}, 7));
    EXPECT_FALSE(report.refusal) << to_string(report.refusal.reason) << ' '
                                 << to_string(report.refusal.parameter) << " used " << report.used
                                 << " of " << report.samples;
    const auto t = values(test::truth());
    const auto found = values(report.drive);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(found[k], t[k], 5.0 * std::sqrt(report.covariance[7 * k]));
    }
  }
}

TEST(JointStreaming, FewSamplesAreJudgedWhileTheyWait) {
  EXPECT_EQ(streamed({}).refusal.reason, RefusalReason::too_little_data);
  const auto still = test::drive(test::truth(), {{0, 0, 8}}, {0.001, 0.001, 0.0}, 1);
  EXPECT_EQ(streamed(still).refusal.reason, RefusalReason::standing_still);
  JointStreaming streaming;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(streaming.add({0.1, kNan, 0, {}}), Status::invalid_argument);
  EXPECT_EQ(streaming.add({0.0, 0, 0, {}}), Status::invalid_argument);
  EXPECT_EQ(streaming.samples(), 0U);
}

TEST(Memory, OfEverySinglePassEstimatorIsConstant) {
  std::printf("bytes of state: linear %zu, wheels %zu, extrinsic %zu, joint %zu\n",
              sizeof(LinearCalibration), sizeof(WheelStreaming), sizeof(ExtrinsicCalibration),
              sizeof(JointStreaming));
  static_assert(sizeof(LinearCalibration) < 1024);
  static_assert(sizeof(WheelStreaming) < 1024);
  static_assert(sizeof(ExtrinsicCalibration) < 512);
  static_assert(sizeof(JointStreaming) < 8 * 1024);
}

}  // namespace
}  // namespace picolo
