// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The robust cost against its definition and its slope against the sums; then the matcher: the
// answer of Gauss-Newton where that converges, a falling cost everywhere.

#include "picolo/matching/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mapped.hpp"
#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/matching/field_cost.hpp"

namespace picolo {
namespace {

using Matcher = LevenbergMarquardtMatcher<DistanceFieldView>;
using GaussNewton = GaussNewtonMatcher<DistanceFieldView>;

FieldWalk walk_of(const Pose2f& pose, float inverse_kernel_squared) {
  return {pose.x_m,
          pose.y_m,
          std::sin(pose.theta_rad),
          std::cos(pose.theta_rad),
          inverse_kernel_squared,
          0.2F};
}

class LevenbergMarquardt : public ::testing::Test {
 protected:
  std::vector<test::Wall> walls_ = test::furnished_room();
  std::unique_ptr<test::SmallMap> map_ = test::draw(walls_);
  DistanceFieldView field_ = map_->core().field();
  Pose2d truth_{0.4, -0.3, 0.7};
  test::Scan scan_ = test::scan_at(walls_, truth_);

  [[nodiscard]] Pose2f in_window(const Pose2d& pose) const {
    return to_window(map_->core().window(), pose);
  }
  [[nodiscard]] Pose2d error_of(const MatchReport& report) const {
    return between(truth_, to_map(map_->core().window(), report.pose));
  }
};

TEST_F(LevenbergMarquardt, GivenAWalkThenTheCostIsTheSumOfLogarithms) {
  const FieldWalk walk = walk_of(in_window({0.5, -0.2, 0.75}), 11.0F);
  double robust = 0.0;
  double plain = 0.0;
  for (std::size_t k = 0; k < scan_.x_m.size(); ++k) {
    const float x = (walk.cosine * scan_.x_m[k] - walk.sine * scan_.y_m[k]) + walk.x_m;
    const float y = (walk.sine * scan_.x_m[k] + walk.cosine * scan_.y_m[k]) + walk.y_m;
    const double r = 1.0 - static_cast<double>(sample_field(field_, x, y).value);
    robust += 0.5 / 11.0 * std::log1p(11.0 * r * r);
    plain += 0.5 * r * r;
  }
  EXPECT_NEAR(static_cast<double>(cost_of_field(field_, walk, scan_.view())), robust,
              1e-5 * robust);
  const FieldWalk no_kernel = walk_of(in_window({0.5, -0.2, 0.75}), 0.0F);
  EXPECT_NEAR(static_cast<double>(cost_of_field(field_, no_kernel, scan_.view())), plain,
              1e-5 * plain);
}

TEST_F(LevenbergMarquardt, GivenPointsOutsideOfTheWindowThenEachCostsAsMuchAsTheFarthest) {
  const std::vector<float> far{1e6F, -1e6F, std::nanf("")};
  const FieldWalk walk = walk_of(in_window({}), 11.0F);
  EXPECT_NEAR(cost_of_field(field_, walk, {far, far}), 3.0F * 0.5F / 11.0F * std::log(12.0F),
              1e-6F);
}

TEST_F(LevenbergMarquardt, GivenSmallMovesThenTheCostFallsAsTheRightHandSidePredicts) {
  // -b is the gradient of the robust cost: the weights of the sums are the kernel's slope.
  Random random{11};
  for (int i = 0; i < 20; ++i) {
    Pose2d about = truth_;
    about.x_m += random.uniform(-0.1, 0.1);
    about.y_m += random.uniform(-0.1, 0.1);
    about.theta_rad += random.uniform(-0.05, 0.05);
    const Pose2f pose = in_window(about);
    const FieldSums sums = walk_field(field_, walk_of(pose, 11.0F), scan_.view());
    constexpr float kStep = 2e-3F;  // crosses cells: the slope jumps there, hence the tolerance
    const auto cost = [&](float dx, float dy, float dt) {
      return cost_of_field(field_,
                           walk_of({pose.x_m + dx, pose.y_m + dy, pose.theta_rad + dt}, 11.0F),
                           scan_.view());
    };
    const float slope_x = (cost(kStep, 0, 0) - cost(-kStep, 0, 0)) / (2 * kStep);
    const float slope_y = (cost(0, kStep, 0) - cost(0, -kStep, 0)) / (2 * kStep);
    const float slope_t = (cost(0, 0, kStep) - cost(0, 0, -kStep)) / (2 * kStep);
    EXPECT_NEAR(sums.bx, -slope_x, 0.05F * std::sqrt(sums.xx) + 1.0F);
    EXPECT_NEAR(sums.by, -slope_y, 0.05F * std::sqrt(sums.yy) + 1.0F);
    EXPECT_NEAR(sums.bt, -slope_t, 0.05F * std::sqrt(sums.tt) + 2.0F);
  }
}

TEST_F(LevenbergMarquardt, GivenDisturbedStartsThenItFindsThePoseAndAgreesWithGaussNewton) {
  for (const Pose2d& offset : {Pose2d{0, 0, 0}, Pose2d{0.2, 0, 0}, Pose2d{0, -0.2, 0.05},
                               Pose2d{-0.15, 0.15, -0.1}, Pose2d{0, 0, 0.15}}) {
    const MatchRequest request{scan_.view(), in_window(truth_ * offset), {}};
    Matcher matcher{{.residual = {.max_iterations = 40}}};
    const MatchReport report = matcher.match(field_, request);
    EXPECT_EQ(report.outcome, MatchOutcome::converged);
    EXPECT_LE(std::hypot(error_of(report).x_m, error_of(report).y_m), 0.015);
    EXPECT_LE(std::abs(error_of(report).theta_rad), 0.004);
    GaussNewton gauss_newton;
    const MatchReport other = gauss_newton.match(field_, request);
    EXPECT_NEAR(report.pose.x_m, other.pose.x_m, 5e-3F);
    EXPECT_NEAR(report.pose.y_m, other.pose.y_m, 5e-3F);
    EXPECT_NEAR(report.pose.theta_rad, other.pose.theta_rad, 2e-3F);
    EXPECT_NEAR(report.inlier_share, other.inlier_share, 0.02F);
  }
}

TEST_F(LevenbergMarquardt, GivenAnyStartThenTheCostNeverRises) {
  Random random{5};
  int rejected = 0;
  for (int i = 0; i < 30; ++i) {
    const Pose2d start = truth_ * Pose2d{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                                         random.uniform(-0.8, 0.8)};
    Matcher matcher{{.residual = {.max_iterations = 60,
                                  .max_step_m = 2.0F,
                                  .max_step_rad = 1.0F,
                                  .max_total_m = 5.0F,
                                  .max_total_rad = 2.0F,
                                  .kernel_m = i % 2 == 0 ? 0.15F : 0.0F}}};
    matcher.begin(field_, {scan_.view(), in_window(start), {}});
    float cost = 3e38F;
    while (!matcher.step()) {
      if (matcher.accepted() == 0) { continue; }
      EXPECT_LE(matcher.cost(), cost * 1.0001F);
      cost = matcher.cost();
    }
    rejected += matcher.report().iterations - matcher.accepted();
  }
  EXPECT_GT(rejected, 0) << "the starts were too easy to see a rejected trial";
}

TEST_F(LevenbergMarquardt, GivenAHeadingFarOffThenItConvergesAtLeastAsOftenAsGaussNewton) {
  Random random{77};
  int by_lm = 0;
  int by_gn = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose2d start = truth_ * Pose2d{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4),
                                         random.uniform(-0.35, 0.35)};
    const GaussNewtonConfig config{
        .max_iterations = 40, .max_total_m = 2.0F, .max_total_rad = 2.0F};
    const MatchRequest request{scan_.view(), in_window(start), {}};
    const auto good = [&](const MatchReport& report) {
      const Pose2d error = error_of(report);
      return std::hypot(error.x_m, error.y_m) < 0.03 && std::abs(error.theta_rad) < 0.01;
    };
    Matcher matcher{{.residual = config}};
    GaussNewton gauss_newton{config};
    by_lm += good(matcher.match(field_, request)) ? 1 : 0;
    by_gn += good(gauss_newton.match(field_, request)) ? 1 : 0;
  }
  RecordProperty("levenberg_marquardt_of_60", by_lm);
  RecordProperty("gauss_newton_of_60", by_gn);
  EXPECT_GE(by_lm, 40);
  EXPECT_GE(by_lm + 3, by_gn);
}

TEST_F(LevenbergMarquardt, GivenAPriorThenItEntersCostAndAnswer) {
  MatchRequest request{scan_.view(), in_window(truth_), {}};
  request.prior.pose = in_window(truth_ * Pose2d{0.1, 0, 0});
  request.prior.information = Matrix3f::diagonal(1e6F, 1e6F, 1e6F);
  Matcher matcher{{.residual = {.max_iterations = 40}}};
  const MatchReport report = matcher.match(field_, request);
  EXPECT_NEAR(report.pose.x_m, request.prior.pose.x_m, 0.01F);
  EXPECT_NEAR(report.pose.y_m, request.prior.pose.y_m, 0.01F);
  EXPECT_LT(report.covariance(0, 0), 1e-6F);
}

TEST_F(LevenbergMarquardt, GivenACorridorThenTheOpenDirectionIsLeftAlone) {
  test::SmallMap map;
  map.core().reset(0.0, 0.0);
  map.core().begin_scan();
  for (int i = -790; i <= 790; ++i) {
    for (const double y : {-1.025, 1.025}) {
      const Pose2f p = to_window(map.core().window(), {0.01 * i, y, 0.0});
      map.core().add_hit({p.x_m, p.y_m});
    }
  }
  const test::Scan scan = test::scan_at(test::endless_corridor(), {0, 0, 0});
  Matcher matcher;
  const MatchReport report = matcher.match(
      map.core().field(), {scan.view(), to_window(map.core().window(), {0.3, 0.1, 0.03}), {}});
  EXPECT_EQ(report.outcome, MatchOutcome::degenerate);
  EXPECT_EQ(report.open_directions, 1);
  const Pose2d found = to_map(map.core().window(), report.pose);
  EXPECT_NEAR(found.x_m, 0.3, 0.03);
  EXPECT_NEAR(found.y_m, 0.0, 0.02);
  EXPECT_NEAR(found.theta_rad, 0.0, 0.01);
}

TEST_F(LevenbergMarquardt, GivenWhatCannotBeMatchedThenTheGuardsSayWhyAndThePoseIsTheStart) {
  const Pose2f start = in_window(truth_ * Pose2d{0.1, 0.1, 0.05});
  Matcher matcher;
  const test::Scan few = test::scan_at(walls_, truth_, 29);
  MatchReport report = matcher.match(field_, {few.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::too_few_points);
  EXPECT_EQ(report.pose, start);

  report = matcher.match(field_, {scan_.view(), {100.0F, 100.0F, 0.0F}, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::out_of_map);

  test::SmallMap blank;
  report = matcher.match(blank.core().field(), {scan_.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::unsolvable);

  Matcher timid{{.residual = {.max_total_m = 0.02F}}};
  report = timid.match(field_, {scan_.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::step_limit);
  EXPECT_EQ(report.pose, start);

  Matcher hasty{{.residual = {.max_iterations = 1}}};
  report = hasty.match(field_, {scan_.view(), start, {}});
  EXPECT_EQ(report.outcome, MatchOutcome::iteration_limit);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_TRUE(hasty.step()) << "further steps change nothing";
}

}  // namespace
}  // namespace picolo
