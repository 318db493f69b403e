// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/plicp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

struct Scan {
  std::vector<float> x;
  std::vector<float> y;
  [[nodiscard]] PointsView view() const { return {x, y}; }
};

struct Wall {
  double ax, ay, bx, by;
};

/// A room of 8 m x 5 m with a niche and a box: every direction is constrained.
std::vector<Wall> room() {
  return {{-3, -2, 5, -2}, {5, -2, 5, 3},  {5, 3, 1, 3},    {1, 3, 1, 4},     {1, 4, -1, 4},
          {-1, 4, -1, 3},  {-1, 3, -3, 3}, {-3, 3, -3, -2}, {2, 0, 2.6, 0.4}, {2.6, 0.4, 2.2, 0.9}};
}

std::vector<Wall> corridor() {
  return {{-50, -1, 50, -1}, {-50, 1, 50, 1}};
}

Scan scan_from(const std::vector<Wall>& walls, const Pose2d& pose, int beams, double noise_m,
               std::uint64_t seed) {
  Random random{seed};
  Scan scan;
  for (int k = 0; k < beams; ++k) {
    const double bearing = -2.3 + 4.6 * k / (beams - 1);
    const double c = std::cos(pose.theta_rad + bearing);
    const double s = std::sin(pose.theta_rad + bearing);
    double range = 12.0;
    for (const Wall& w : walls) {
      const double ex = w.bx - w.ax;
      const double ey = w.by - w.ay;
      const double determinant = c * ey - s * ex;
      if (std::abs(determinant) < 1e-12) { continue; }
      const double dx = w.ax - pose.x_m;
      const double dy = w.ay - pose.y_m;
      const double t = (dx * ey - dy * ex) / determinant;
      const double u = (dx * s - dy * c) / determinant;
      if (t > 0.0 && u >= 0.0 && u <= 1.0 && t < range) { range = t; }
    }
    const double noise = noise_m * random.gaussian();
    if (range >= 12.0) { continue; }
    scan.x.push_back(static_cast<float>((range + noise) * std::cos(bearing)));
    scan.y.push_back(static_cast<float>((range + noise) * std::sin(bearing)));
  }
  return scan;
}

Pose2d error_of(const Pose2f& found, const Pose2d& truth) {
  return between(truth, to_f64(found));
}

TEST(PlIcp, RecoversTheMotionBetweenTwoScans) {
  PlIcpMatcher<720> matcher;
  Random random{4};
  for (std::uint64_t trial = 1; trial <= 50; ++trial) {
    Pose2d a;
    a.x_m = random.uniform(-1, 1);
    a.y_m = random.uniform(-1, 1);
    a.theta_rad = random.uniform(-3, 3);
    Pose2d motion;
    motion.x_m = random.uniform(-0.15, 0.15);
    motion.y_m = random.uniform(-0.15, 0.15);
    motion.theta_rad = random.uniform(-0.15, 0.15);
    const Scan reference = scan_from(room(), a, 600, 0.005, 2 * trial);
    const Scan current = scan_from(room(), a * motion, 600, 0.005, 2 * trial + 1);
    const MatchReport report = matcher.match(reference.view(), {.points = current.view()});
    EXPECT_EQ(report.outcome, MatchOutcome::converged) << trial;
    const Pose2d error = error_of(report.pose, motion);
    EXPECT_LT(std::hypot(error.x_m, error.y_m), 0.006) << trial;
    EXPECT_LT(std::abs(error.theta_rad), 0.002) << trial;
    EXPECT_LT(report.iterations, 25);
  }
}

TEST(PlIcp, IdenticalScansGiveExactlyNoMotion) {
  PlIcpMatcher<720> matcher;
  const Scan scan = scan_from(room(), {}, 400, 0.0, 1);
  const MatchReport report = matcher.match(scan.view(), {.points = scan.view()});
  EXPECT_EQ(report.outcome, MatchOutcome::converged);
  EXPECT_NEAR(report.pose.x_m, 0.0F, 1e-5F);
  EXPECT_NEAR(report.pose.theta_rad, 0.0F, 1e-5F);
  EXPECT_EQ(report.iterations, 1);
}

TEST(PlIcp, SteppingAndMatchingAreTheSame) {
  const Scan reference = scan_from(room(), {}, 500, 0.005, 1);
  const Scan current = scan_from(room(), {0.1, 0.05, 0.1}, 500, 0.005, 2);
  PlIcpMatcher<720> at_once;
  PlIcpMatcher<720> sliced;
  const MatchReport whole = at_once.match(reference.view(), {.points = current.view()});
  sliced.core().begin(reference.view(), {.points = current.view()});
  int steps = 0;
  while (!sliced.core().step()) { ++steps; }
  EXPECT_EQ(sliced.core().report().pose, whole.pose);
  EXPECT_EQ(steps + 1, whole.iterations);
  EXPECT_TRUE(sliced.core().step()) << "a final report stays final";
  for (const std::size_t looks : {1U, 700U, 100'000U}) {
    sliced.core().begin_slices(reference.view(), {.points = current.view()});
    int slices = 1;
    while (!sliced.core().step_slice(looks)) { ++slices; }
    EXPECT_EQ(sliced.core().report().pose, whole.pose) << looks;
    EXPECT_EQ(sliced.core().report().covariance, whole.covariance) << looks;
    EXPECT_EQ(sliced.core().report().iterations, whole.iterations) << looks;
    EXPECT_EQ(slices == 1, looks == 100'000U) << slices << " slices of " << looks;
  }
}

TEST(PlIcp, MovedObjectsAreTrimmed) {
  const Scan reference = scan_from(room(), {}, 600, 0.003, 1);
  std::vector<Wall> moved = room();
  moved[8] = {1.5, -1.2, 2.1, -0.8};
  moved[9] = {2.1, -0.8, 1.7, -0.3};
  const Pose2d motion{0.08, -0.03, 0.06};
  const Scan current = scan_from(moved, motion, 600, 0.003, 2);
  PlIcpMatcher<720> matcher;
  const Pose2d error =
      error_of(matcher.match(reference.view(), {.points = current.view()}).pose, motion);
  EXPECT_LT(std::hypot(error.x_m, error.y_m), 0.01);
  EXPECT_LT(std::abs(error.theta_rad), 0.005);
}

TEST(PlIcp, ACorridorIsReportedAsDegenerateAndItsAxisStays) {
  const Scan reference = scan_from(corridor(), {}, 400, 0.0, 1);
  const Scan current = scan_from(corridor(), {0.2, 0.05, 0.02}, 400, 0.0, 2);
  PlIcpMatcher<720> matcher;
  const MatchReport report = matcher.match(reference.view(), {.points = current.view()});
  EXPECT_EQ(report.outcome, MatchOutcome::degenerate);
  EXPECT_GT(report.conditioning.condition, 1000.0F);
  EXPECT_EQ(report.open_directions, 1);
  EXPECT_GT(std::abs(report.conditioning.eigenvectors(0, 0)), 0.99F) << "along the corridor";
  EXPECT_NEAR(report.pose.y_m, 0.05F, 0.01F);
  EXPECT_NEAR(report.pose.theta_rad, 0.02F, 0.005F);
  EXPECT_NEAR(report.pose.x_m, 0.0F, 0.02F) << "nothing is invented along the corridor";
}

TEST(PlIcp, APriorDecidesWhatACorridorLeavesOpenAndNothingElse) {
  const Scan reference = scan_from(corridor(), {}, 400, 0.0, 1);
  const Scan current = scan_from(corridor(), {0.2, 0.05, 0.02}, 400, 0.0, 2);
  PlIcpMatcher<720> matcher;
  MatchRequest request{.points = current.view()};
  request.prior = {{0.18F, 0.0F, 0.0F}, Matrix3f::diagonal(400.0F, 400.0F, 400.0F)};
  const MatchReport report = matcher.match(reference.view(), request);
  EXPECT_EQ(report.outcome, MatchOutcome::degenerate);
  EXPECT_NEAR(report.pose.x_m, 0.18F, 0.02F);
  EXPECT_NEAR(report.pose.y_m, 0.05F, 0.01F);
  EXPECT_NEAR(report.pose.theta_rad, 0.02F, 0.005F);
  EXPECT_LT(report.covariance(0, 0), 0.01F);
}

TEST(PlIcp, CovarianceIsHonestInTheRoom) {
  PlIcpMatcher<720> matcher{{.sigma_m = 0.005F}};
  double squares = 0.0;
  constexpr int kTrials = 100;
  const Pose2d motion{0.05, 0.02, 0.03};
  for (std::uint64_t trial = 1; trial <= kTrials; ++trial) {
    const Scan reference = scan_from(room(), {}, 500, 0.005, 2 * trial);
    const Scan current = scan_from(room(), motion, 500, 0.005, 2 * trial + 1);
    const MatchReport report = matcher.match(reference.view(), {.points = current.view()});
    const Pose2d error = error_of(report.pose, motion);
    squares += error.theta_rad * error.theta_rad / static_cast<double>(report.covariance(2, 2));
  }
  // The reference's own noise is not in the covariance: up to a few times too small, never absurd.
  EXPECT_GT(squares / kTrials, 0.3);
  EXPECT_LT(squares / kTrials, 8.0);
}

TEST(PlIcp, TooFewPointsOrTooFarKeepTheStart) {
  PlIcpMatcher<720> matcher;
  const Scan few = scan_from(room(), {}, 20, 0.0, 1);
  const Scan scan = scan_from(room(), {}, 300, 0.0, 1);
  const Pose2f start{0.3F, 0.1F, 0.2F};
  const MatchReport short_report =
      matcher.match(few.view(), {.points = scan.view(), .start = start});
  EXPECT_EQ(short_report.outcome, MatchOutcome::too_few_points);
  EXPECT_EQ(short_report.pose, start);
  const Pose2f far{40.0F, 0.0F, 0.0F};
  const MatchReport far_report = matcher.match(scan.view(), {.points = scan.view(), .start = far});
  EXPECT_EQ(far_report.outcome, MatchOutcome::too_few_points);
  EXPECT_EQ(far_report.pose, far);
  PlIcpMatcher<720> bounded{{.max_total_m = 0.01F}};
  const Scan moved = scan_from(room(), {0.15, 0.0, 0.0}, 300, 0.0, 2);
  const MatchReport limited = bounded.match(scan.view(), {.points = moved.view()});
  EXPECT_EQ(limited.outcome, MatchOutcome::step_limit);
  EXPECT_EQ(limited.pose, Pose2f{});
}

TEST(PlIcp, PointsBeyondTheStorageAreLeftOut) {
  PlIcpMatcher<200> small;
  const Scan scan = scan_from(room(), {}, 600, 0.0, 1);
  const MatchReport report = small.match(scan.view(), {.points = scan.view()});
  EXPECT_NEAR(report.pose.theta_rad, 0.0F, 1e-5F);
  EXPECT_LE(report.points, 200);
}

}  // namespace
}  // namespace picolo
