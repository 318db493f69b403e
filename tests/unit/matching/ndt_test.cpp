// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Gradient and Hessian of the score against differences, then the matcher in a room.

#include "picolo/matching/ndt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/ndt_sums.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

using Map = NdtMap<40, 40>;

std::unique_ptr<Map> drawn(const std::vector<test::Wall>& walls) {
  auto map = std::make_unique<Map>();
  for (const Pose2d pose : {Pose2d{0, 0, 0}, Pose2d{1, 1, 1}, Pose2d{-1, -0.5, 2}}) {
    const test::Scan scan = test::scan_at(walls, pose, 1440);
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
      map->core().add(transform(to_window(map->core().window(), pose), {scan.x_m[k], scan.y_m[k]}));
    }
  }
  return map;
}

NdtWalk walk_of(const Pose2f& pose) {
  return {pose.x_m, pose.y_m, std::sin(pose.theta_rad), std::cos(pose.theta_rad)};
}

/// True when no grid puts the points of the two poses into different cells.
bool same_cells(const NdtView& view, const Pose2f& a, const Pose2f& b, Point2f base_p) {
  const Point2f pa = transform(a, base_p);
  const Point2f pb = transform(b, base_p);
  for (const float shift : {0.0F, 0.5F}) {
    if (std::floor(pa.x_m * view.cells_per_m + shift) !=
            std::floor(pb.x_m * view.cells_per_m + shift) ||
        std::floor(pa.y_m * view.cells_per_m + shift) !=
            std::floor(pb.y_m * view.cells_per_m + shift)) {
      return false;
    }
  }
  return true;
}

TEST(NdtSums, GivenPointsWithinTheirCellsThenGradientAndHessianAreTheDerivativesOfTheScore) {
  const auto map = drawn(test::furnished_room());
  const NdtView view = map->core().view();
  Random random{8};
  constexpr float kStep = 1e-3F;
  int checked = 0;
  for (int i = 0; i < 4000; ++i) {
    const Pose2f pose = to_window(
        map->core().window(),
        {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-3.0, 3.0)});
    const auto x_m = static_cast<float>(random.uniform(-4.0, 4.0));
    const auto y_m = static_cast<float>(random.uniform(-3.0, 3.0));
    const PointsView point{std::span{&x_m, 1}, std::span{&y_m, 1}};
    const NdtSums here = walk_ndt(view, walk_of(pose), point);
    if (here.score < 0.05F) { continue; }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Pose2f low = pose;
      Pose2f high = pose;
      float& l = axis == 0 ? low.x_m : axis == 1 ? low.y_m : low.theta_rad;
      float& h = axis == 0 ? high.x_m : axis == 1 ? high.y_m : high.theta_rad;
      l -= kStep;
      h += kStep;
      if (!same_cells(view, low, high, {x_m, y_m})) { continue; }
      const NdtSums below = walk_ndt(view, walk_of(low), point);
      const NdtSums above = walk_ndt(view, walk_of(high), point);
      const float span = h - l;
      ASSERT_NEAR(
          here.gradient[axis], -(above.score - below.score) / span,
          0.02F * (std::abs(here.gradient[axis]) + std::sqrt(here.information(axis, axis)) + 3.0F));
      for (std::size_t other = 0; other < 3; ++other) {
        const float numeric = (above.gradient[other] - below.gradient[other]) / span;
        const float size = std::sqrt(here.information(axis, axis) * here.information(other, other));
        ASSERT_NEAR(here.hessian(axis, other), numeric, 0.02F * (size + std::abs(numeric)) + 2.0F)
            << axis << "," << other;
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(NdtSums, GivenAnyPoseThenTheInformationIsPositiveDefinite) {
  const auto map = drawn(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.2, 0.1, 0.3});
  for (const double offset : {0.0, 0.1, 0.3}) {
    const NdtSums sums = walk_ndt(
        map->core().view(),
        walk_of(to_window(map->core().window(), {0.2 + offset, 0.1 - offset, 0.3 + offset})),
        scan.view());
    const Conditioning conditioning = conditioning_of(sums.information, 2.0F);
    EXPECT_GT(conditioning.eigenvalues[0], 0.0F);
  }
}

TEST(NdtSums, GivenABlurThenScoreAndGradientAreThoseOfWiderCells) {
  const auto map = drawn(test::furnished_room());
  const float x_m = 1.7F;
  const float y_m = 2.9F;
  const PointsView point{std::span{&x_m, 1}, std::span{&y_m, 1}};
  NdtWalk walk = walk_of(to_window(map->core().window(), {0.0, 0.0, 0.1}));
  float last = 0.0F;
  for (const float blur : {1.0F, 2.0F, 4.0F}) {
    walk.sharpness = 1.0F / (blur * blur);
    const NdtSums here = walk_ndt(map->core().view(), walk, point);
    EXPECT_GE(here.score, last) << "a wider cell is never less likely";
    last = here.score;
    constexpr float kStep = 1e-3F;
    NdtWalk moved = walk;
    moved.y_m += kStep;
    const NdtSums above = walk_ndt(map->core().view(), moved, point);
    moved.y_m -= 2 * kStep;
    const NdtSums below = walk_ndt(map->core().view(), moved, point);
    EXPECT_NEAR(here.gradient[1], -(above.score - below.score) / (2 * kStep),
                0.02F * std::abs(here.gradient[1]) + 0.05F);
  }
  EXPECT_GT(last, 0.1F);
}

TEST(NdtSums, GivenPointsThatMeetNoCellThenTheyAddNothing) {
  const auto map = drawn(test::furnished_room());
  const std::vector<float> far{1e6F, -7.0F, std::nanf("")};
  const NdtSums sums = walk_ndt(map->core().view(), {0, 0, 0, 1}, {far, far});
  EXPECT_EQ(sums.points, 0.0F);
  EXPECT_EQ(sums.score, 0.0F);
}

class Ndt : public ::testing::TestWithParam<Pose2d> {};

TEST_P(Ndt, FindsThePoseFromADisturbedStartAndRaisesTheScoreAtEachStep) {
  const auto map = drawn(test::furnished_room());
  const Pose2d truth{0.4, -0.3, 0.7};
  const test::Scan scan = test::scan_at(test::furnished_room(), truth);
  NdtMatcher matcher;
  matcher.begin(map->core().view(),
                {scan.view(), to_window(map->core().window(), truth * GetParam()), {}});
  float cost = 3e38F;
  float blur = matcher.blur();
  EXPECT_EQ(blur, 4.0F);
  while (!matcher.step()) {
    EXPECT_LE(matcher.blur(), blur);
    if (matcher.blur() == blur) { EXPECT_LE(matcher.cost(), cost); }
    cost = matcher.blur() == blur ? matcher.cost() : 3e38F;
    blur = matcher.blur();
  }
  EXPECT_EQ(blur, 1.0F);
  const MatchReport report = matcher.report();
  EXPECT_EQ(report.outcome, MatchOutcome::converged);
  const Pose2d error = between(truth, to_map(map->core().window(), report.pose));
  EXPECT_LE(std::hypot(error.x_m, error.y_m), 0.02);
  EXPECT_LE(std::abs(error.theta_rad), 0.006);
  EXPECT_GE(report.inlier_share, 0.95F);
  EXPECT_LE(report.mean_residual_m, 0.03F);
  EXPECT_LE(report.conditioning.condition, 20.0F);
  EXPECT_LT(report.covariance(0, 0), 1e-3F);
  EXPECT_TRUE(matcher.step()) << "further steps change nothing";
}

INSTANTIATE_TEST_SUITE_P(Starts, Ndt,
                         ::testing::Values(Pose2d{0, 0, 0}, Pose2d{0.2, 0, 0},
                                           Pose2d{0, -0.2, 0.05}, Pose2d{-0.15, 0.15, -0.1},
                                           Pose2d{0.3, 0.2, 0.0}, Pose2d{0, 0, 0.2},
                                           Pose2d{0.35, -0.3, 0.3}));

TEST(NdtMatcher, GivenACorridorThenTheOpenDirectionIsLeftAlone) {
  auto map = std::make_unique<Map>();
  for (int i = -1000; i <= 1000; ++i) {
    for (const double y : {-1.025, 1.025}) {
      const Pose2f p = to_window(map->core().window(), {0.01 * i, y, 0.0});
      map->core().add({p.x_m, p.y_m});
    }
  }
  const test::Scan scan = test::scan_at(test::endless_corridor(), {0, 0, 0});
  const Pose2f start = to_window(map->core().window(), {0.3, 0.1, 0.03});
  NdtMatcher matcher;
  MatchReport report = matcher.match(map->core().view(), {scan.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::degenerate);
  EXPECT_EQ(report.open_directions, 1);
  EXPECT_NEAR(to_map(map->core().window(), report.pose).x_m, 0.3, 0.05);
  EXPECT_NEAR(to_map(map->core().window(), report.pose).y_m, 0.0, 0.02);
  EXPECT_NEAR(report.pose.theta_rad, 0.0F, 0.01F);
}

TEST(NdtMatcher, GivenAPriorThenItEntersTheAnswer) {
  const auto map = drawn(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0, 0, 0});
  MatchRequest request{scan.view(), to_window(map->core().window(), {0, 0, 0}), {}};
  request.prior.pose = to_window(map->core().window(), {0.1, 0.0, 0.0});
  request.prior.information = Matrix3f::diagonal(1e7F, 1e7F, 1e7F);
  NdtMatcher matcher;
  const MatchReport report = matcher.match(map->core().view(), request);
  EXPECT_NEAR(to_map(map->core().window(), report.pose).x_m, 0.1, 0.01);
  EXPECT_LT(report.covariance(0, 0), 2e-7F);
}

TEST(NdtMatcher, GivenWhatCannotBeMatchedThenTheGuardsSayWhy) {
  const auto map = drawn(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0, 0, 0});
  const Pose2f start = to_window(map->core().window(), {0.1, 0.1, 0.05});
  NdtMatcher matcher;
  const test::Scan few = test::scan_at(test::furnished_room(), {0, 0, 0}, 29);
  MatchReport report = matcher.match(map->core().view(), {few.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::too_few_points);
  EXPECT_EQ(report.pose, start);
  report = matcher.match(map->core().view(), {scan.view(), {100.0F, 0.0F, 0.0F}, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::out_of_map);
  NdtMatcher timid{{.max_total_m = 0.02F}};
  report = timid.match(map->core().view(), {scan.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::step_limit);
  EXPECT_EQ(report.pose, start);
  NdtMatcher hasty{{.max_iterations = 1}};
  report = hasty.match(map->core().view(), {scan.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::iteration_limit);
}

}  // namespace
}  // namespace picolo
