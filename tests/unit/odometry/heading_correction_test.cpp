// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/heading_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

/// Odometry's arc; the truth turns by (1 + a) dtheta + b dx.
Pose2d arc(double path_m, double turn_rad) {
  return exp_se2(Tangent2<double>{path_m, 0.0, turn_rad});
}

TEST(HeadingCorrection, WithoutKnowledgeNothingIsCorrected) {
  const HeadingCorrection correction;
  const Pose2d motion = arc(0.7, 0.4);
  const Pose2d corrected = correction.corrected(motion);
  EXPECT_NEAR(corrected.x_m, motion.x_m, 1e-12);
  EXPECT_NEAR(corrected.y_m, motion.y_m, 1e-12);
  EXPECT_NEAR(corrected.theta_rad, motion.theta_rad, 1e-12);
}

TEST(HeadingCorrection, FindsScaleAndDriftFromNoisyMatches) {
  constexpr double kScale = 0.03;
  constexpr double kPerMetre = 0.061;  // 3.5 degrees a metre
  HeadingCorrection correction;
  Random random{4};
  for (int i = 0; i < 2000; ++i) {
    const double path = random.uniform(-0.2, 1.0);
    const double turn = random.uniform(-0.5, 0.5);
    const double measured = (1.0 + kScale) * turn + kPerMetre * path + 0.01 * random.gaussian();
    correction.update(arc(path, turn), wrap_angle(measured), 1e-4);
  }
  EXPECT_NEAR(correction.scale(), kScale, 0.01);
  EXPECT_NEAR(correction.per_m_rad(), kPerMetre, 0.01);
  EXPECT_NEAR(correction.corrected(arc(1.0, 0.2)).theta_rad, 1.03 * 0.2 + 0.061, 0.01);
  EXPECT_LT(correction.variance(arc(1.0, 0.2)), HeadingCorrection{}.variance(arc(1.0, 0.2)) / 10.0);
}

TEST(HeadingCorrection, AHopTeachesNothing) {
  HeadingCorrection correction;
  for (int i = 0; i < 100; ++i) { correction.update(arc(0.5, 0.1), 0.1, 1e-4); }
  const double scale = correction.scale();
  const double per_m = correction.per_m_rad();
  correction.update(arc(0.5, 0.1), 1.2, 1e-4);
  EXPECT_EQ(correction.scale(), scale);
  EXPECT_EQ(correction.per_m_rad(), per_m);
}

TEST(HeadingCorrection, StandingStillTeachesNothing) {
  HeadingCorrection correction;
  for (int i = 0; i < 100; ++i) { correction.update(Pose2d{}, 0.005, 1e-4); }
  EXPECT_EQ(correction.scale(), 0.0);
  EXPECT_EQ(correction.per_m_rad(), 0.0);
}

TEST(HeadingCorrection, TheArcKeepsItsLength) {
  HeadingCorrection correction;
  for (int i = 0; i < 500; ++i) { correction.update(arc(0.5, 0.0), 0.03, 1e-4); }
  const Tangent2<double> path = log_se2(correction.corrected(arc(2.0, 0.0)));
  EXPECT_NEAR(path.x_m, 2.0, 1e-9);
  EXPECT_NEAR(path.theta_rad, 0.12, 0.02);
}

}  // namespace
}  // namespace picolo
