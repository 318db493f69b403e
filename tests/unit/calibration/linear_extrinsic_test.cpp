// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <limits>

#include "picolo/calibration/extrinsic_calibration.hpp"
#include "picolo/calibration/linear_calibration.hpp"
#include "picolo/core/random.hpp"
#include "simulated_drive.hpp"

namespace picolo {
namespace {

Pose2d apply(const Matrix3d& x, const Pose2d& o) {
  return {x(0, 0) * o.x_m + x(0, 1) * o.y_m + x(0, 2) * o.theta_rad,
          x(1, 0) * o.x_m + x(1, 1) * o.y_m + x(1, 2) * o.theta_rad,
          x(2, 0) * o.x_m + x(2, 1) * o.y_m + x(2, 2) * o.theta_rad};
}

TEST(LinearCalibration, FindsTheMatrixFromMoreSamplesThanAnyBuffer) {
  const Matrix3d truth{{1.04, 0.01, -0.02, 0.03, 0.97, 0.004, -0.05, 0.02, 1.08}};
  LinearCalibration calibration;
  Random random{1};
  for (int k = 0; k < 200'000; ++k) {
    Pose2d o;
    o.x_m = random.uniform(-0.1, 0.1);
    o.y_m = random.uniform(-0.01, 0.01);
    o.theta_rad = random.uniform(-0.1, 0.1);
    Pose2d s = apply(truth, o);
    s.x_m += 1e-3 * random.gaussian();
    s.theta_rad += 1e-3 * random.gaussian();
    ASSERT_EQ(calibration.add({o, s}), Status::ok);
  }
  LinearReport report;
  ASSERT_EQ(calibration.solve(report), Status::ok);
  EXPECT_EQ(report.samples, 200'000U);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(report.correction.elements[k], truth.elements[k],
                5.0 * report.deviation.elements[k] + 1e-12);
  }
  EXPECT_LT(report.rms_after_m, report.rms_before_m);
  static_assert(sizeof(LinearCalibration) < 1024);
}

TEST(LinearCalibration, WithoutSidewaysOdometryItsColumnStaysTheIdentity) {
  LinearCalibration calibration;
  Random random{2};
  for (int k = 0; k < 500; ++k) {
    Pose2d o;
    o.x_m = random.uniform(0.0, 0.1);
    o.theta_rad = random.uniform(-0.1, 0.1);
    ASSERT_EQ(calibration.add({o, {1.05 * o.x_m, 0.02 * o.x_m, 0.9 * o.theta_rad}}), Status::ok);
  }
  LinearReport report;
  ASSERT_EQ(calibration.solve(report), Status::ok);
  EXPECT_NEAR(report.correction(0, 0), 1.05, 1e-9);
  EXPECT_NEAR(report.correction(1, 0), 0.02, 1e-9);
  EXPECT_NEAR(report.correction(2, 2), 0.9, 1e-9);
  EXPECT_NEAR(report.correction(1, 1), 1.0, 1e-9);
  EXPECT_NEAR(report.correction(0, 1), 0.0, 1e-9);
  EXPECT_EQ(calibration.solve(report, false), Status::degenerate);
}

TEST(LinearCalibration, RefusesWhatDoesNotDetermineIt) {
  LinearCalibration straight;
  LinearCalibration still;
  LinearCalibration arc;
  for (int k = 0; k < 50; ++k) {
    const double x = 0.01 * k;
    ASSERT_EQ(straight.add({{x, 0, 0}, {x, 0, 0}}), Status::ok);
    ASSERT_EQ(still.add({{0, 0, 0}, {0, 0, 0}}), Status::ok);
    ASSERT_EQ(arc.add({{x, 0, 0.5 * x}, {x, 0, 0.5 * x}}), Status::ok);
  }
  LinearReport report;
  EXPECT_EQ(straight.solve(report, false), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::straight_only);
  EXPECT_EQ(still.solve(report, false), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::standing_still);
  EXPECT_EQ(arc.solve(report), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::constant_arc);
  EXPECT_EQ(LinearCalibration{}.solve(report), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::too_little_data);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(straight.add({{kNan, 0, 0}, {}}), Status::invalid_argument);
  EXPECT_EQ(straight.samples(), 50U);
}

void feed(ExtrinsicCalibration& calibration, const std::vector<test::Leg>& legs,
          std::uint64_t seed) {
  const DriveParameters vehicle = test::truth();
  for (const MotionSample& sample : test::drive(vehicle, legs, {0.001, 0.001, 0.0}, seed)) {
    ASSERT_EQ(calibration.add({base_motion(vehicle, sample), sample.lidar_motion}), Status::ok);
  }
}

TEST(ExtrinsicCalibration, FindsYawThenPosition) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    ExtrinsicCalibration calibration;
    feed(calibration, test::sufficient_legs(seed), seed);
    ExtrinsicReport report;
    ASSERT_EQ(calibration.solve(report), Status::ok);
    const Pose2d truth = test::truth().base_T_lidar;
    EXPECT_NEAR(report.yaw_rad.value, truth.theta_rad, 5 * report.yaw_rad.std);
    EXPECT_NEAR(report.x_m.value, truth.x_m, 5 * report.x_m.std);
    EXPECT_NEAR(report.y_m.value, truth.y_m, 5 * report.y_m.std);
    EXPECT_LT(report.yaw_rad.std, 0.002);
    EXPECT_LT(report.x_m.std, 0.002);
    EXPECT_NEAR(report.yaw_scale, 1.0, 0.005);
    EXPECT_FALSE(report.position_refusal);
  }
}

TEST(ExtrinsicCalibration, WithoutStraightsTheYawComesFromTurns) {
  ExtrinsicCalibration calibration;
  feed(calibration, {{4, 6, 10}, {6, 4, 10}, {3, 6, 10}}, 3);
  ExtrinsicReport report;
  ASSERT_EQ(calibration.solve(report), Status::ok);
  EXPECT_TRUE(report.yaw_from_turns);
  EXPECT_NEAR(report.yaw_rad.value, test::truth().base_T_lidar.theta_rad, 5 * report.yaw_rad.std);
}

TEST(ExtrinsicCalibration, WithoutTranslationTheYawIsRefused) {
  ExtrinsicCalibration calibration;
  const DriveParameters vehicle{
      0.075, 0.075, 0.4, {0.2, 0, 0.03}};  // equal wheels: the base turns on the spot
  for (const MotionSample& sample :
       test::drive(vehicle, {{-2, 2, 20}, {2, -2, 20}}, {0.001, 0.001, 0.0}, 4)) {
    ASSERT_EQ(calibration.add({base_motion(vehicle, sample), sample.lidar_motion}), Status::ok);
  }
  ExtrinsicReport report;
  EXPECT_EQ(calibration.solve(report), Status::degenerate);
  EXPECT_EQ(report.yaw_refusal, (Refusal{RefusalReason::no_translation, Parameter::lidar_yaw}));
}

TEST(ExtrinsicCalibration, StraightOnlyGivesYawAndRefusesPosition) {
  ExtrinsicCalibration calibration;
  const DriveParameters vehicle{0.075, 0.075, 0.4, {0.2, 0, 0.03}};
  for (const MotionSample& sample : test::drive(vehicle, {{5, 5, 20}}, {0.001, 0.0, 0.0}, 4)) {
    ASSERT_EQ(calibration.add({base_motion(vehicle, sample), sample.lidar_motion}), Status::ok);
  }
  ExtrinsicReport report;
  ASSERT_EQ(calibration.solve(report), Status::ok);
  EXPECT_NEAR(report.yaw_rad.value, 0.03, 5 * report.yaw_rad.std);
  EXPECT_EQ(report.position_refusal.parameter, Parameter::lidar_x);
}

TEST(ExtrinsicCalibration, StandingAndShortAreRefused) {
  ExtrinsicCalibration still;
  for (int k = 0; k < 100; ++k) { ASSERT_EQ(still.add({{}, {}}), Status::ok); }
  ExtrinsicReport report;
  EXPECT_EQ(still.solve(report), Status::degenerate);
  EXPECT_EQ(report.yaw_refusal.reason, RefusalReason::standing_still);
  EXPECT_EQ(ExtrinsicCalibration{}.solve(report), Status::degenerate);
  EXPECT_EQ(report.yaw_refusal.reason, RefusalReason::too_little_data);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(still.add({{}, {0, kNan, 0}}), Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
