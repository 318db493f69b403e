// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/segments.hpp"

#include <gtest/gtest.h>

#include "scenes.hpp"

namespace picolo {
namespace {

TEST(Segments, GivenOnePercentOfScaleErrorThenOnePercentIsReported) {
  const auto reference = test::straight(251);
  auto estimate = reference;
  for (auto& pose : estimate) { pose.translation_m.x *= 1.01; }
  std::vector<double> path_m(reference.size());
  const auto report = segment_errors(reference, estimate, {}, path_m);
  ASSERT_TRUE(report);
  // Stretches end at the first pose beyond the length: 101 m and 201 m of way.
  EXPECT_EQ(report->by_length[0].count, 15U);
  EXPECT_NEAR(report->by_length[0].translation_share, 0.0101, 1e-12);
  EXPECT_EQ(report->by_length[1].count, 5U);
  EXPECT_NEAR(report->by_length[1].translation_share, 0.01005, 1e-12);
  EXPECT_EQ(report->by_length[2].count, 0U);
  EXPECT_EQ(report->overall.count, 20U);
  EXPECT_NEAR(report->overall.translation_share, (15 * 0.0101 + 5 * 0.01005) / 20, 1e-12);
  EXPECT_EQ(report->overall.rotation_rad_per_m, 0.0);
}

TEST(Segments, GivenSteadyYawDriftThenItsRateIsReported) {
  const auto reference = test::straight(130);
  std::vector<Transform3d> estimate;
  for (int i = 0; i < 130; ++i) { estimate.push_back(test::pose(i, 0, 0, 0, 0, 0.001 * i)); }
  std::vector<double> path_m(reference.size());
  const auto report = segment_errors(reference, estimate, {}, path_m);
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->overall.rotation_rad_per_m, 0.101 / 100, 1e-12);
}

TEST(Segments, RefusesShortWaysAndWrongSpans) {
  const auto reference = test::straight(50);
  std::vector<double> path_m(50);
  EXPECT_EQ(segment_errors(reference, reference, {}, path_m).status(), Status::not_ready);
  EXPECT_EQ(segment_errors(reference, test::straight(49), {}, path_m).status(),
            Status::invalid_argument);
  EXPECT_EQ(segment_errors(reference, reference, {}, {}).status(), Status::invalid_argument);
  EXPECT_EQ(segment_errors(reference, reference, {.step_frames = 0}, path_m).status(),
            Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
