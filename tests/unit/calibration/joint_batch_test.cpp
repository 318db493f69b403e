// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/joint_batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calib_files.hpp"

namespace picolo {
namespace {

std::string printed(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::vector<double> answers(const JointReport& report) {
  const DriveParameters& d = report.drive;
  return {d.track_m,          2 * d.radius_left_m, 2 * d.radius_right_m,
          d.base_T_lidar.x_m, d.base_T_lidar.y_m,  d.base_T_lidar.theta_rad};
}

struct Case {
  const char* name;
  int third;
};

class PublishedDigits : public ::testing::TestWithParam<Case> {};

TEST_P(PublishedDigits, EveryPrintedDigitAndTheCovariance) {
  PICOLO_NEED_DATA("calib/censi_l90.tuples.txt.gz");
  const auto [name, third] = GetParam();
  const std::vector<MotionSample> samples = test::censi_samples(name, third);
  const std::vector<double> expected =
      test::censi_expected(third < 0 ? name : std::string{name} + "_" + std::to_string(third));
  ASSERT_EQ(expected.size(), 44U);
  SpanSource<MotionSample> source{samples};
  JointReport report;
  ASSERT_EQ(calibrate_joint(source, {}, report), Status::ok) << to_string(report.refusal.reason);
  const std::vector<double> found = answers(report);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(printed(found[k]), printed(expected[k])) << "parameter " << k;
  }
  // The published order is r_L, r_R, axle, x, y, theta, like ours. The published matrix is itself
  // rounded to six digits.
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      const double value = expected[8 + 6 * i + j];
      EXPECT_NEAR(report.covariance[6 * i + j], value, 0.005 * std::abs(value)) << i << ' ' << j;
    }
  }
  EXPECT_EQ(report.samples, samples.size());
  EXPECT_LT(report.inlier_covariance[14], report.covariance[14]);
}

INSTANTIATE_TEST_SUITE_P(Censi, PublishedDigits,
                         ::testing::Values(Case{"censi_l90", -1}, Case{"censi_l90", 0},
                                           Case{"censi_l90", 1}, Case{"censi_l90", 2},
                                           Case{"censi_lmov", -1}, Case{"censi_lmov", 0},
                                           Case{"censi_lmov", 1}, Case{"censi_lmov", 2}));

TEST(JointBatch, WithoutOutlierRoundsItIsTheFirstPass) {
  PICOLO_NEED_DATA("calib/censi_l90.tuples.txt.gz");
  const std::vector<MotionSample> samples = test::censi_samples("censi_l90");
  SpanSource<MotionSample> source{samples};
  JointReport report;
  ASSERT_EQ(calibrate_joint(source, {.outlier_rounds = 0}, report), Status::ok);
  const std::vector<double> found = answers(report);
  const char* expected[6] = {"0.0932595",   "0.0428547",   "0.0433036",
                             "-0.00352567", "-0.00384306", "-1.48721"};
  for (std::size_t k = 0; k < 6; ++k) { EXPECT_EQ(printed(found[k]), expected[k]); }
  EXPECT_EQ(report.used, samples.size());
}

TEST(JointBatch, RefusesAConfigurationThatIsNotValid) {
  SpanSource<MotionSample> source{{}};
  JointReport report;
  EXPECT_EQ(calibrate_joint(source, {.outlier_rounds = 99}, report), Status::invalid_argument);
  EXPECT_EQ(calibrate_joint(source, {.quantile = 0.0}, report), Status::invalid_argument);
}

TEST(JointBatch, WithoutSamplesThereIsTooLittleData) {
  SpanSource<MotionSample> source{{}};
  JointReport report;
  EXPECT_EQ(calibrate_joint(source, {}, report), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::too_little_data);
}

}  // namespace
}  // namespace picolo
