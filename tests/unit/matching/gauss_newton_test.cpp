// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The sums against a plain double walk and against differences of the cost, then the matcher in
// small worlds: what it finds, and every guard.

#include "picolo/matching/gauss_newton.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/field_sums.hpp"
#include "picolo/matching/surface.hpp"
#include "support/walls.hpp"

namespace picolo {
namespace {

using Map = RollingMap<320, 320>;
using Matcher = GaussNewtonMatcher<DistanceFieldView>;

/// The map as a vehicle standing at the origin would draw it, from a few places.
std::unique_ptr<Map> mapped(const std::vector<test::Wall>& walls) {
  auto map = std::make_unique<Map>();
  map->core().reset(0.0, 0.0);
  for (const Pose2d pose : {Pose2d{0, 0, 0}, Pose2d{1, 1, 1}, Pose2d{-1, -0.5, 2}}) {
    const test::Scan scan = test::scan_at(walls, pose, 1440);
    map->core().begin_scan();
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
      const Point2f p =
          transform(to_window(map->core().window(), pose), {scan.x_m[k], scan.y_m[k]});
      map->core().add_hit(p);
    }
  }
  return map;
}

/// Both walls of the endless corridor as far as the window reaches, without the gaps that beams
/// leave far away.
std::unique_ptr<Map> mapped_corridor() {
  auto map = std::make_unique<Map>();
  map->core().reset(0.0, 0.0);
  map->core().begin_scan();
  for (int i = -790; i <= 790; ++i) {
    for (const double y : {-1.025, 1.025}) {
      const Pose2f p = to_window(map->core().window(), {0.01 * i, y, 0.0});
      map->core().add_hit({p.x_m, p.y_m});
    }
  }
  return map;
}

FieldWalk walk_at(const Pose2f& pose, float inverse_kernel_squared) {
  return {pose.x_m,
          pose.y_m,
          std::sin(pose.theta_rad),
          std::cos(pose.theta_rad),
          inverse_kernel_squared,
          0.2F};
}

TEST(FieldSums, EqualAPlainWalkInDouble) {
  const auto map = mapped(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.3, 0.2, 0.5}, 357);
  const Pose2f pose = to_window(map->core().window(), {0.35, 0.17, 0.52});
  const FieldSums sums = walk_field(map->core().field(), walk_at(pose, 11.0F), scan.view());
  double xx = 0;
  double xt = 0;
  double tt = 0;
  double bt = 0;
  double residual_sum = 0;
  for (std::size_t k = 0; k < scan.x_m.size(); ++k) {
    const double c = std::cos(static_cast<double>(pose.theta_rad));
    const double s = std::sin(static_cast<double>(pose.theta_rad));
    const double ax = c * static_cast<double>(scan.x_m[k]) - s * static_cast<double>(scan.y_m[k]);
    const double ay = s * static_cast<double>(scan.x_m[k]) + c * static_cast<double>(scan.y_m[k]);
    const FieldSample at = sample_field(map->core().field(), static_cast<float>(ax) + pose.x_m,
                                        static_cast<float>(ay) + pose.y_m);
    const double gx = static_cast<double>(at.slope_x_per_m);
    const double gy = static_cast<double>(at.slope_y_per_m);
    const double jt = gy * ax - gx * ay;
    const double residual = 1.0 - static_cast<double>(at.value);
    const double w = 1.0 / (1.0 + 11.0 * residual * residual);
    xx += w * gx * gx;
    xt += w * gx * jt;
    tt += w * jt * jt;
    bt += w * jt * residual;
    residual_sum += residual;
  }
  EXPECT_NEAR(sums.xx, xx, 1e-3 * xx);
  EXPECT_NEAR(sums.xt, xt, 1e-3 * std::sqrt(xx * tt));
  EXPECT_NEAR(sums.tt, tt, 1e-3 * tt);
  EXPECT_NEAR(sums.bt, bt, 1e-3 * std::sqrt(tt));
  EXPECT_NEAR(sums.residual, residual_sum, 1e-2);
  EXPECT_EQ(sums.inside, static_cast<float>(scan.x_m.size()));
}

void expect_same(const FieldSums& a, const FieldSums& b) {
  using Words = std::array<float, sizeof(FieldSums) / sizeof(float)>;
  EXPECT_EQ(std::bit_cast<Words>(a), std::bit_cast<Words>(b));
}

TEST(FieldSums, PointByPointGivesTheSameBitsAsEightAtOnce) {
  // The contract of the order of summation: lane l sums the points l, l + 8, ... alone.
  const auto map = mapped(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.3, 0.2, 0.5}, 359);
  std::vector<std::int8_t> along_x(scan.x_m.size());
  std::vector<std::int8_t> along_y(scan.x_m.size());
  surface_directions(scan.view(), {}, along_x, along_y);
  const FieldWalk walk = walk_at(to_window(map->core().window(), {0.32, 0.21, 0.49}), 11.0F);
  const PointsView with_surfaces{scan.x_m, scan.y_m, along_x, along_y};
  for (float shift_m : {0.0F, 8.0F}) {  // the second leaves some of the points outside
    FieldWalk at = walk;
    at.x_m += shift_m;
    const DistanceFieldView field = map->core().field();
    expect_same(walk_points<false>(field, at, scan.view()),
                walk_lanes<false>(field, at, scan.view()));
    const FieldSums whole = walk_lanes<true>(field, at, with_surfaces);
    expect_same(walk_points<true>(field, at, with_surfaces), whole);
    const FieldSums plain = walk_field(field, at, scan.view());
    EXPECT_EQ(whole.residual, plain.residual) << "surfaces change slopes, not residuals";
    EXPECT_LT(whole.xx + whole.yy, plain.xx + plain.yy);
    EXPECT_EQ(whole.inside<300.0F, shift_m> 0.0F);
  }
}

TEST(FieldSums, APointOnASurfaceIsConstrainedAcrossItOnly) {
  const auto map = mapped(test::furnished_room());
  const DistanceFieldView field = map->core().field();
  const Pose2f pose = to_window(map->core().window(), {0.32, 0.21, 0.49});
  Random random{8};
  for (int i = 0; i < 300; ++i) {
    const std::array x_m{static_cast<float>(random.uniform(-3.0, 3.0))};
    const std::array y_m{static_cast<float>(random.uniform(-3.0, 3.0))};
    const double direction = random.uniform(-3.0, 3.0);
    const std::array along_x{static_cast<std::int8_t>(std::lround(127 * std::cos(direction)))};
    const std::array along_y{static_cast<std::int8_t>(std::lround(127 * std::sin(direction)))};
    const FieldSums free = walk_field(field, walk_at(pose, 0.0F), {x_m, y_m});
    const FieldSums bound = walk_field(field, walk_at(pose, 0.0F), {x_m, y_m, along_x, along_y});
    // Moving along the surface, in the axes of the window, must not change the residual; moving
    // across it as without surfaces.
    const auto [bx, by] = std::pair{static_cast<double>(bound.bx), static_cast<double>(bound.by)};
    const auto [fx, fy] = std::pair{static_cast<double>(free.bx), static_cast<double>(free.by)};
    const double quantised = std::atan2(along_y[0], along_x[0]);
    const double tx = std::cos(quantised + static_cast<double>(pose.theta_rad));
    const double ty = std::sin(quantised + static_cast<double>(pose.theta_rad));
    EXPECT_NEAR(bx * tx + by * ty, 0.0, 0.01 * std::abs(fx * tx + fy * ty) + 1e-5);
    EXPECT_NEAR(-bx * ty + by * tx, -fx * ty + fy * tx, 1e-5);
  }
}

TEST(FieldSums, RightHandSideIsMinusTheGradientOfTheCost) {
  // One point at a time, well inside of one interpolation cell: d(r^2 / 2)/dT = r dr/dT = -J r.
  const auto map = mapped(test::furnished_room());
  const DistanceFieldView field = map->core().field();
  Random random{3};
  int checked = 0;
  for (int i = 0; i < 3000; ++i) {
    const float x_m = static_cast<float>(random.uniform(-3.0, 3.0));
    const float y_m = static_cast<float>(random.uniform(-3.0, 3.0));
    const float theta = static_cast<float>(random.uniform(-3.0, 3.0));
    const Pose2f pose = to_window(map->core().window(), {0.1, -0.1, static_cast<double>(theta)});
    const auto cost = [&](const Pose2f& at) {
      const FieldSums sums =
          walk_field(field, walk_at(at, 0.0F), {std::span{&x_m, 1}, std::span{&y_m, 1}});
      return 0.5 * static_cast<double>(sums.residual) * static_cast<double>(sums.residual);
    };
    const Point2f p = transform(pose, {x_m, y_m});
    const double u = static_cast<double>(p.x_m) * 20.0 - 0.5;
    const double v = static_cast<double>(p.y_m) * 20.0 - 0.5;
    if (std::abs(u - std::floor(u) - 0.5) > 0.3 || std::abs(v - std::floor(v) - 0.5) > 0.3) {
      continue;
    }
    const FieldSums sums =
        walk_field(field, walk_at(pose, 0.0F), {std::span{&x_m, 1}, std::span{&y_m, 1}});
    constexpr float kStep = 1e-3F;
    const double dx = (cost({pose.x_m + kStep, pose.y_m, pose.theta_rad}) -
                       cost({pose.x_m - kStep, pose.y_m, pose.theta_rad})) /
                      (2e-3);
    const double dy = (cost({pose.x_m, pose.y_m + kStep, pose.theta_rad}) -
                       cost({pose.x_m, pose.y_m - kStep, pose.theta_rad})) /
                      (2e-3);
    const double dt = (cost({pose.x_m, pose.y_m, pose.theta_rad + kStep}) -
                       cost({pose.x_m, pose.y_m, pose.theta_rad - kStep})) /
                      (2e-3);
    ASSERT_NEAR(sums.bx, -dx, 5e-3);
    ASSERT_NEAR(sums.by, -dy, 5e-3);
    ASSERT_NEAR(sums.bt, -dt, 2e-2);
    checked += sums.bx != 0.0F ? 1 : 0;
  }
  EXPECT_GT(checked, 100);
}

class GaussNewtonRoom : public ::testing::TestWithParam<Pose2d> {};

TEST_P(GaussNewtonRoom, FindsThePoseFromADisturbedStart) {
  const auto map = mapped(test::furnished_room());
  const Pose2d truth{0.4, -0.3, 0.7};
  const test::Scan scan = test::scan_at(test::furnished_room(), truth);
  const Pose2d start = truth * GetParam();
  Matcher matcher;
  const MatchReport report =
      matcher.match(map->core().field(), {scan.view(), to_window(map->core().window(), start), {}});
  EXPECT_EQ(report.outcome, MatchOutcome::converged);
  const Pose2d error = between(truth, to_map(map->core().window(), report.pose));
  EXPECT_LE(std::hypot(error.x_m, error.y_m), 0.015);
  EXPECT_LE(std::abs(error.theta_rad), 0.004);
  EXPECT_GE(report.inlier_share, 0.95F);
  EXPECT_LE(report.conditioning.condition, 20.0F);
}

INSTANTIATE_TEST_SUITE_P(Starts, GaussNewtonRoom,
                         ::testing::Values(Pose2d{0, 0, 0}, Pose2d{0.2, 0, 0},
                                           Pose2d{0, -0.2, 0.05}, Pose2d{-0.15, 0.15, -0.1},
                                           Pose2d{0, 0, 0.15}, Pose2d{0.1, 0.1, 0.1}));

TEST(GaussNewton, StepByStepIsTheSameAsMatch) {
  const auto map = mapped(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0.4, -0.3, 0.7});
  const MatchRequest request{scan.view(), to_window(map->core().window(), {0.5, -0.2, 0.75}), {}};
  Matcher matcher;
  const MatchReport whole = matcher.match(map->core().field(), request);
  matcher.begin(map->core().field(), request);
  int steps = 0;
  while (!matcher.step()) { ++steps; }
  EXPECT_EQ(steps + 1, whole.iterations);
  EXPECT_EQ(matcher.report().pose, whole.pose);
  EXPECT_TRUE(matcher.step()) << "further steps change nothing";
  EXPECT_EQ(matcher.report().iterations, whole.iterations);
}

TEST(GaussNewton, ACorridorIsDegenerateAndTheOpenDirectionIsLeftAlone) {
  const auto map = mapped_corridor();
  const test::Scan scan = test::scan_at(test::endless_corridor(), {0, 0, 0});
  Matcher matcher;
  const MatchReport report = matcher.match(
      map->core().field(), {scan.view(), to_window(map->core().window(), {0.3, 0.1, 0.03}), {}});
  EXPECT_EQ(report.outcome, MatchOutcome::degenerate);
  const Pose2d found = to_map(map->core().window(), report.pose);
  EXPECT_NEAR(found.x_m, 0.3, 0.03) << "nothing in the scan says where along the corridor";
  EXPECT_NEAR(found.y_m, 0.0, 0.02);
  EXPECT_NEAR(found.theta_rad, 0.0, 0.01);
}

TEST(GaussNewton, APriorHoldsTheOpenDirection) {
  const auto map = mapped_corridor();
  const test::Scan scan = test::scan_at(test::endless_corridor(), {0, 0, 0});
  MatchRequest request{scan.view(), to_window(map->core().window(), {0.3, 0.1, 0.03}), {}};
  request.prior.pose = to_window(map->core().window(), {0.2, 0.05, 0.0});
  request.prior.information = Matrix3f::diagonal(100.0F, 100.0F, 100.0F);
  Matcher matcher;
  const MatchReport report = matcher.match(map->core().field(), request);
  EXPECT_EQ(report.outcome, MatchOutcome::degenerate);
  EXPECT_NEAR(to_map(map->core().window(), report.pose).x_m, 0.2, 0.05);
  EXPECT_NEAR(to_map(map->core().window(), report.pose).y_m, 0.0, 0.02);
  EXPECT_NEAR(report.covariance(0, 0), 0.01F, 0.005F)
      << "along the corridor the prior's variance is all there is";
  EXPECT_LT(report.covariance(1, 1), 0.001F);
}

TEST(GaussNewton, GuardsEndWithTheirOutcomeAndThePoseOfTheStart) {
  const auto map = mapped(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0, 0, 0});
  const Pose2f start = to_window(map->core().window(), {0.1, 0.1, 0.05});
  Matcher matcher;

  const test::Scan few = test::scan_at(test::furnished_room(), {0, 0, 0}, 29);
  MatchReport report = matcher.match(map->core().field(), {few.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::too_few_points);
  EXPECT_EQ(report.pose, start);

  const Pose2f away{100.0F, 100.0F, 0.0F};
  report = matcher.match(map->core().field(), {scan.view(), away, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::out_of_map);
  EXPECT_EQ(report.pose, away);

  auto blank = std::make_unique<Map>();
  report = matcher.match(blank->core().field(),
                         {scan.view(), to_window(blank->core().window(), {}), {}});
  EXPECT_EQ(report.outcome, MatchOutcome::unsolvable);

  Matcher timid{{.max_total_m = 0.02F}};
  report = timid.match(map->core().field(), {scan.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::step_limit);
  EXPECT_EQ(report.pose, start);

  Matcher hasty{{.max_iterations = 2}};
  report = hasty.match(map->core().field(), {scan.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::iteration_limit);
  EXPECT_EQ(report.iterations, 2);
}

TEST(GaussNewton, NoStepIsLongerThanItsLimits) {
  const auto map = mapped(test::furnished_room());
  const test::Scan scan = test::scan_at(test::furnished_room(), {0, 0, 0});
  Matcher matcher{{.max_step_m = 0.01F, .max_step_rad = 0.002F}};
  Pose2f last = to_window(map->core().window(), {0.1, 0.1, 0.05});
  matcher.begin(map->core().field(), {scan.view(), last, {}});
  bool done = false;
  while (!done) {
    done = matcher.step();
    const Pose2f now = matcher.report().pose;
    EXPECT_LE(std::hypot(now.x_m - last.x_m, now.y_m - last.y_m), 0.01F + 1e-6F);
    EXPECT_LE(std::abs(wrap_angle(now.theta_rad - last.theta_rad)), 0.002F + 1e-6F);
    last = now;
  }
}

TEST(GaussNewton, ItDoesNotOscillateAcrossTheBendsOfTheField) {
  // Undamped, about one scan in ten of a drive jumps to and fro until the iteration limit.
  const auto map = mapped(test::furnished_room());
  Random random{17};
  Matcher matcher;
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    const double y = random.uniform(-1.0, 1.0);
    const double theta = random.uniform(-3.0, 3.0);
    const test::Scan scan = test::scan_at(test::furnished_room(), {x, y, theta}, 180);
    const Pose2d start = Pose2d{x, y, theta} * Pose2d{0.05, -0.05, 0.03};
    const MatchReport report = matcher.match(
        map->core().field(), {scan.view(), to_window(map->core().window(), start), {}});
    EXPECT_EQ(report.outcome, MatchOutcome::converged) << "drive " << i;
  }
}

TEST(GaussNewton, NonsensePointsAreIgnored) {
  const auto map = mapped(test::furnished_room());
  test::Scan scan = test::scan_at(test::furnished_room(), {0, 0, 0});
  Matcher matcher;
  const Pose2f start = to_window(map->core().window(), {0.1, 0.05, 0.02});
  scan.x_m[5] = std::nanf("");
  scan.y_m[9] = INFINITY;
  const MatchReport report = matcher.match(map->core().field(), {scan.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::converged);
  EXPECT_NEAR(to_map(map->core().window(), report.pose).x_m, 0.0, 0.015);
}

}  // namespace
}  // namespace picolo
