// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Closest points: exact partners, and the motion between two scans of a room.

#include "picolo/matching/icp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/point_alignment.hpp"
#include "support/property.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

using Matcher = IcpMatcher<720>;

TEST(Icp, GivenAScanAndItselfMovedThenTheMotionIsExact) {
  const test::Scan reference = test::scan_at(test::furnished_room(), {0.2, 0.1, 0.3});
  for (const Pose2f& motion :
       {Pose2f{0, 0, 0}, Pose2f{0.05F, -0.03F, 0.02F}, Pose2f{-0.08F, 0.06F, -0.04F}}) {
    test::Scan scan = reference;
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
      const Point2f p = transform(inverse(motion), {scan.x_m[k], scan.y_m[k]});
      scan.x_m[k] = p.x_m;
      scan.y_m[k] = p.y_m;
    }
    Matcher matcher;
    const MatchReport report = matcher.match(reference.view(), {scan.view(), {}, {}});
    EXPECT_EQ(report.outcome, MatchOutcome::converged);
    EXPECT_NEAR(report.pose.x_m, motion.x_m, 2e-3F);
    EXPECT_NEAR(report.pose.y_m, motion.y_m, 2e-3F);
    EXPECT_NEAR(report.pose.theta_rad, motion.theta_rad, 1e-3F);
    EXPECT_LT(report.mean_residual_m, 2e-3F);
    EXPECT_GE(report.inlier_share, 0.88F);
  }
}

TEST(Icp, GivenTwoScansOfARoomThenTheMotionIsFoundToCentimetres) {
  const Pose2d from{0.2, 0.1, 0.3};
  const test::Scan reference = test::scan_at(test::furnished_room(), from, 720);
  for (const Pose2d& motion : {Pose2d{0.15, 0.05, 0.08}, Pose2d{-0.1, 0.1, -0.1}}) {
    const test::Scan scan = test::scan_at(test::furnished_room(), from * motion, 720);
    Matcher matcher;
    const MatchReport report = matcher.match(reference.view(), {scan.view(), {}, {}});
    EXPECT_NEAR(report.pose.x_m, motion.x_m, 0.02);
    EXPECT_NEAR(report.pose.y_m, motion.y_m, 0.02);
    EXPECT_NEAR(report.pose.theta_rad, motion.theta_rad, 0.01);
    EXPECT_GT(report.iterations, 1);
  }
}

TEST(Icp, GivenAnIntruderInFrontThenTrimmingKeepsTheAnswer) {
  const test::Scan reference = test::scan_at(test::furnished_room(), {0, 0, 0}, 720);
  test::Scan scan = test::scan_at(test::furnished_room(), {0.05, 0.02, 0.03}, 720);
  for (std::size_t k = 100; k < 150; ++k) {  // 7 % of the points stand 0.4 m too near
    const float range = std::hypot(scan.x_m[k], scan.y_m[k]);
    scan.x_m[k] *= (range - 0.4F) / range;
    scan.y_m[k] *= (range - 0.4F) / range;
  }
  Matcher trimmed{{.keep_share = 0.85F}};
  Matcher greedy{{.keep_share = 1.0F}};
  const auto error = [](const MatchReport& report) {
    return std::hypot(report.pose.x_m - 0.05F, report.pose.y_m - 0.02F);
  };
  const float with = error(trimmed.match(reference.view(), {scan.view(), {}, {}}));
  const float without = error(greedy.match(reference.view(), {scan.view(), {}, {}}));
  EXPECT_LT(with, 0.012F);
  EXPECT_LT(with, without);
}

TEST(Icp, GivenStepsThenTheyAreTheSameAsMatch) {
  const test::Scan reference = test::scan_at(test::furnished_room(), {0, 0, 0});
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.1, 0.02, 0.03});
  Matcher matcher;
  const MatchReport whole = matcher.match(reference.view(), {scan.view(), {}, {}});
  matcher.core().begin(reference.view(), {scan.view(), {}, {}});
  int steps = 1;
  while (!matcher.core().step()) { ++steps; }
  EXPECT_EQ(steps, whole.iterations);
  EXPECT_EQ(matcher.core().report().pose, whole.pose);
  EXPECT_TRUE(matcher.core().step());
}

TEST(Icp, GivenWhatCannotBeMatchedThenTheGuardsSayWhyAndThePoseIsTheStart) {
  const test::Scan reference = test::scan_at(test::furnished_room(), {0, 0, 0});
  const test::Scan few = test::scan_at(test::furnished_room(), {0, 0, 0}, 20);
  Matcher matcher;
  EXPECT_EQ(matcher.match(reference.view(), {few.view(), {}, {}}).outcome,
            MatchOutcome::too_few_points);
  EXPECT_EQ(matcher.match(few.view(), {reference.view(), {}, {}}).outcome,
            MatchOutcome::too_few_points);
  const Pose2f away{50.0F, 0.0F, 0.0F};
  MatchReport report = matcher.match(reference.view(), {reference.view(), away, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::out_of_map);
  EXPECT_EQ(report.pose, away);
  Matcher timid{{.max_total_m = 0.01F}};
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.1, 0.1, 0.0});
  report = timid.match(reference.view(), {scan.view(), {}, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::step_limit);
  EXPECT_EQ(report.pose, Pose2f{});
  Matcher hasty{{.max_iterations = 1}};
  EXPECT_EQ(hasty.match(reference.view(), {scan.view(), {}, {}}).outcome,
            MatchOutcome::iteration_limit);
  const std::vector<float> same(50, 1.0F);
  EXPECT_EQ(matcher.match({same, same}, {{same, same}, {}, {}}).outcome, MatchOutcome::unsolvable);
}

TEST(Icp, GivenNonsensePointsThenTheyHaveNoPartner) {
  test::Scan reference = test::scan_at(test::furnished_room(), {0, 0, 0});
  test::Scan scan = reference;
  reference.x_m[7] = std::nanf("");
  scan.y_m[9] = INFINITY;
  scan.x_m[11] = std::nanf("");
  Matcher matcher;
  const MatchReport report = matcher.match(reference.view(), {scan.view(), {}, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::converged);
  EXPECT_NEAR(report.pose.x_m, 0.0F, 1e-3F);
}

TEST(Icp, GivenMoreThanTheStorageThenTheRestIsLeftOut) {
  const test::Scan reference = test::scan_at(test::furnished_room(), {0, 0, 0}, 360);
  IcpMatcher<100> small;
  const MatchReport report = small.match(reference.view(), {reference.view(), {}, {}});
  EXPECT_LE(report.points, 100);
  EXPECT_EQ(report.outcome, MatchOutcome::converged);
}

// One iteration with partners that are known to be right is the closed form in double.
RC_GTEST_PROP(IcpProperty, OneIterationIsTheClosedForm, ()) {
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1'000'000);
  Random random{seed};
  test::Scan reference;
  test::Scan scan;
  std::vector<Point2<double>> a;
  std::vector<Point2<double>> b;
  const Pose2d motion{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                      random.uniform(-0.003, 0.003)};
  for (int i = 0; i < 64; ++i) {  // a lattice of 1 m: every partner is obvious
    const auto x = static_cast<float>(i % 8);
    const auto y = static_cast<float>(i / 8);
    reference.x_m.push_back(x);
    reference.y_m.push_back(y);
    const Point2<double> p = transform(
        inverse(motion),
        Point2<double>{static_cast<double>(x) + 0.01 * random.gaussian(), static_cast<double>(y)});
    scan.x_m.push_back(static_cast<float>(p.x_m));
    scan.y_m.push_back(static_cast<float>(p.y_m));
    a.push_back({static_cast<double>(x), static_cast<double>(y)});
    b.push_back({static_cast<double>(scan.x_m.back()), static_cast<double>(scan.y_m.back())});
  }
  IcpMatcher<64> matcher{{.keep_share = 1.0F}};
  matcher.core().begin(reference.view(), {scan.view(), {}, {}});
  static_cast<void>(matcher.core().step());
  const Result<Pose2d> expected = align_points(a, b);
  RC_ASSERT(static_cast<bool>(expected));
  const Pose2f found = matcher.core().report().pose;
  RC_ASSERT(std::abs(static_cast<double>(found.x_m) - (*expected).x_m) < 1e-5);
  RC_ASSERT(std::abs(static_cast<double>(found.y_m) - (*expected).y_m) < 1e-5);
  RC_ASSERT(std::abs(static_cast<double>(found.theta_rad) - (*expected).theta_rad) < 2e-6);
}

}  // namespace
}  // namespace picolo
