// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/pose_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "problems.hpp"

namespace picolo {
namespace {

constexpr PoseSolverConfig kExact{
    .max_iterations = 50, .converged_m = 1e-12F, .converged_rad = 1e-12F};

Pose3d start_near(const Pose3d& truth, double angle_rad, double shift_m) {
  return perturbed(truth, Tangent3<double>{{angle_rad, -angle_rad, angle_rad / 2},
                                           {shift_m, shift_m / 2, -shift_m}});
}

TEST(PoseSolver, GivenExactCorrespondencesThenTheTruthIsFoundAtEveryRotation) {
  for (const auto& truth : test::poses()) {
    const auto scene = test::scene(truth, 60, 60, 0.0);
    for (const auto method : {SolveMethod::gauss_newton, SolveMethod::levenberg_marquardt}) {
      PoseSolverConfig config = kExact;
      config.method = method;
      const auto report = PoseSolver<double>{config}.solve(
          {scene.planes, scene.lines, start_near(truth, 0.1, 0.5)});
      EXPECT_EQ(report.outcome, SolveOutcome::converged);
      EXPECT_LT(test::distance_m(report.pose, truth), 1e-10);
      EXPECT_LT(test::angle_rad(report.pose, truth), 1e-11);
      EXPECT_LE(report.iterations, 15);
    }
  }
}

TEST(PoseSolver, GivenFloatsThenTheAnswerAgreesWithDoublesToFloatAccuracy) {
  const Pose3d truth{exp_so3(Vector3d{0.02, -0.01, 0.2}), {0.5, -1, 0.1}};
  const auto scene = test::scene(truth, 200, 100, 0.02);
  std::vector<PlaneResidual<float>> planes;
  std::vector<LineResidual<float>> lines;
  for (const auto& p : scene.planes) {
    planes.push_back({to_f32(p.point_m), to_f32(p.plane_m), to_f32(p.normal)});
  }
  for (const auto& l : scene.lines) {
    lines.push_back({to_f32(l.point_m), to_f32(l.line_m), to_f32(l.side), to_f32(l.other)});
  }
  const auto exact = PoseSolver<double>{kExact}.solve({scene.planes, scene.lines, {}});
  const auto single = PoseSolver<float>{{.max_iterations = 20}}.solve({planes, lines, {}});
  EXPECT_EQ(single.outcome, SolveOutcome::converged);
  EXPECT_LT(test::distance_m(to_f64(single.pose), exact.pose), 1e-5);
  EXPECT_LT(test::angle_rad(to_f64(single.pose), exact.pose), 1e-6);
}

TEST(PoseSolver, GivenOutliersThenGemanMcClureIgnoresThem) {
  const Pose3d truth{exp_so3(Vector3d{0.02, -0.01, 0.1}), {0.2, -0.1, 0.1}};
  auto scene = test::scene(truth, 200, 0, 0.005);
  for (std::size_t i = 0; i < 60; ++i) {
    auto& plane = scene.planes[i * 3];
    plane.plane_m = sum(plane.plane_m, scaled(plane.normal, 1.5));
  }
  PoseSolverConfig config = kExact;
  const auto naive = PoseSolver<double>{config}.solve({scene.planes, {}, {}});
  config.plane_kernel = {.kind = RobustKind::geman_mcclure, .width = 0.3F};
  config.max_iterations = 100;
  const auto robust = PoseSolver<double>{config}.solve({scene.planes, {}, truth});
  EXPECT_GT(test::distance_m(naive.pose, truth), 0.02);
  EXPECT_LT(test::distance_m(robust.pose, truth), 0.005);
}

TEST(PoseSolver, GivenParallelPlanesThenOnlyTheirDirectionsMove) {
  Random random{8};
  std::vector<PlaneResidual<double>> ground;
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(-10, 10);
    const double y = random.uniform(-10, 10);
    ground.push_back({{x, y, 0}, {0, 0, 0.3}, {0, 0, 1}});
  }
  const Pose3d start{{}, {1, 2, 0}};
  const auto report = PoseSolver<double>{kExact}.solve({ground, {}, start});
  EXPECT_EQ(report.outcome, SolveOutcome::degenerate);
  EXPECT_EQ(report.degenerate_directions, 3);
  EXPECT_NEAR(report.pose.translation_m.x, 1, 1e-12);
  EXPECT_NEAR(report.pose.translation_m.y, 2, 1e-12);
  EXPECT_NEAR(report.pose.translation_m.z, 0.3, 1e-9);
  EXPECT_LT(report.eigenvalues[2], 1e-9);
  EXPECT_GT(report.eigenvalues[3], 1.0);
}

TEST(PoseSolver, GivenACorridorThenTheLongDirectionStaysAtTheStart) {
  Random random{9};
  const Pose3d truth{exp_so3(Vector3d{0.005, -0.003, 0.02}), {0.4, 0.1, -0.05}};
  std::vector<PlaneResidual<double>> walls;
  for (int i = 0; i < 300; ++i) {
    const double along = random.uniform(-10, 10);
    const double across = random.uniform(-1, 1);
    const bool floor = i % 2 == 0;
    const Vector3d n = floor ? Vector3d{0, 0, 1} : Vector3d{0, 1, 0};
    const Vector3d p =
        floor ? Vector3d{along, across, -1} : Vector3d{along, i % 4 == 1 ? 2.0 : -2.0, across};
    walls.push_back({p, transform(truth, p), n});
  }
  const auto report = PoseSolver<double>{kExact}.solve({walls, {}, {}});
  EXPECT_EQ(report.outcome, SolveOutcome::degenerate);
  EXPECT_EQ(report.degenerate_directions, 1);
  EXPECT_NEAR(report.pose.translation_m.x, 0.0, 0.01);  // the start
  EXPECT_NEAR(report.pose.translation_m.y, 0.1, 0.02);
  EXPECT_LT(test::angle_rad(report.pose, truth), 1e-2);
}

TEST(PoseSolver, GivenNoiseThenTheCovarianceIsTheSpreadOfTheAnswers) {
  const Pose3d truth{exp_so3(Vector3d{0.1, 0.2, -0.3}), {1, 2, 3}};
  double nees = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const auto scene = test::scene(truth, 150, 0, 0.05, 100 + static_cast<std::uint64_t>(run));
    const auto report = PoseSolver<double>{kExact}.solve({scene.planes, {}, truth});
    const Vector3d t = difference(report.pose.translation_m, truth.translation_m);
    const Vector3d r = log_so3(compose(report.pose.rotation, inverse(truth.rotation)));
    const std::array<double, 6> e{r.x, r.y, r.z, t.x, t.y, t.z};
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        nees += e[i] * report.information[i * 6 + j] * e[j] / report.residual_variance;
      }
    }
    double identity = 0;  // covariance is information's inverse times the variance
    for (std::size_t k = 0; k < 6; ++k) {
      identity += report.covariance[k] * report.information[k * 6];
    }
    EXPECT_NEAR(identity / report.residual_variance, 1.0, 1e-9);
  }
  // Chi-square with 6 * 200 degrees of freedom: mean 1200, standard deviation 49.
  EXPECT_NEAR(nees, 6 * kRuns, 4 * 49);
}

TEST(PoseSolver, GivenStepsOneByOneThenTheReportIsThatOfSolve) {
  const Pose3d truth{exp_so3(Vector3d{0.1, 0.2, -0.3}), {1, 2, 3}};
  const auto scene = test::scene(truth, 50, 50, 0.05);
  PoseSolver<double> solver{kExact};
  const PoseProblem<double> problem{scene.planes, scene.lines, start_near(truth, 0.05, 0.2)};
  const auto whole = solver.solve(problem);
  solver.begin(problem);
  int calls = 1;
  while (!solver.step()) {
    EXPECT_FALSE(solver.done());
    ++calls;
  }
  EXPECT_TRUE(solver.done());
  EXPECT_TRUE(solver.step());
  EXPECT_EQ(calls, whole.iterations + 1);
  EXPECT_EQ(solver.report().pose, whole.pose);
  EXPECT_EQ(solver.report().covariance, whole.covariance);
}

TEST(PoseSolver, GivenTheDistanceFormThenTheSameMinimumTakesMoreStepsAndDamping) {
  const Pose3d truth{exp_so3(Vector3d{0.05, -0.02, 0.1}), {0.3, -0.2, 0.1}};
  const auto lines = test::scene(truth, 0, 300, 0.05).lines;
  PoseSolverConfig config{.method = SolveMethod::levenberg_marquardt,
                          .max_iterations = 300,
                          .converged_m = 1e-9F,
                          .converged_rad = 1e-9F};
  const auto two = PoseSolver<double>{config}.solve({{}, lines, {}});
  config.line_form = LineForm::distance;
  const auto one = PoseSolver<double>{config}.solve({{}, lines, {}});
  EXPECT_EQ(two.outcome, SolveOutcome::converged);
  EXPECT_EQ(one.outcome, SolveOutcome::converged);
  EXPECT_LT(test::distance_m(one.pose, two.pose), 1e-7);
  EXPECT_GT(one.iterations, 2 * two.iterations);
  // Undamped, a Hessian that lacks half of its rank makes steps twice too long: it never settles.
  config.method = SolveMethod::gauss_newton;
  EXPECT_EQ(PoseSolver<double>{config}.solve({{}, lines, {}}).outcome,
            SolveOutcome::iteration_limit);
}

TEST(PoseSolver, GivenAWildStartThenLevenbergMarquardtNeverRaisesTheCost) {
  const Pose3d truth{exp_so3(Vector3d{0.1, 0.2, -0.3}), {1, 2, 3}};
  const auto scene = test::scene(truth, 80, 20, 0.02);
  PoseSolver<double> solver{{.method = SolveMethod::levenberg_marquardt,
                             .max_iterations = 100,
                             .converged_m = 1e-11F,
                             .converged_rad = 1e-11F,
                             .max_step_rad = 3.0F}};
  const Pose3d start{exp_so3(Vector3d{1.0, -0.8, 0.9}), {5, -5, 5}};
  const auto report = solver.solve({scene.planes, scene.lines, start});
  EXPECT_EQ(report.outcome, SolveOutcome::converged);
  EXPECT_LT(test::distance_m(report.pose, truth), 0.05);
}

TEST(PoseSolver, RefusesTooLittleAndNonsense) {
  const auto scene = test::scene({}, 5, 4, 0.0);
  const Pose3d start{{}, {1, 2, 3}};
  const auto few = PoseSolver<double>{}.solve({scene.planes, scene.lines, start});
  EXPECT_EQ(few.outcome, SolveOutcome::too_few_residuals);
  EXPECT_EQ(few.pose, start);
  auto broken = test::scene({}, 20, 0, 0.0).planes;
  broken[3].point_m.x = std::numeric_limits<double>::quiet_NaN();
  const auto nan = PoseSolver<double>{}.solve({broken, {}, start});
  EXPECT_EQ(nan.outcome, SolveOutcome::unsolvable);
  EXPECT_EQ(nan.pose, start);
  const std::vector<PlaneResidual<double>> empty(20);
  EXPECT_EQ(PoseSolver<double>{}.solve({empty, {}, start}).outcome, SolveOutcome::unsolvable);
}

TEST(PoseSolver, GivenALimitThenStepsAreShortenedAndCounted) {
  const Pose3d truth{{}, {3, 0, 0}};
  const auto scene = test::scene(truth, 60, 0, 0.0);
  const auto report =
      PoseSolver<double>{{.max_iterations = 2, .max_step_m = 0.5F}}.solve({scene.planes, {}, {}});
  EXPECT_EQ(report.outcome, SolveOutcome::iteration_limit);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_NEAR(norm(report.pose.translation_m), 1.0, 0.05);
}

TEST(PoseSolverConfig, IsCheckedAtCompileTime) {
  static_assert(PoseSolverConfig{}.valid());
  static_assert(!PoseSolverConfig{.max_iterations = 0}.valid());
  static_assert(
      !PoseSolverConfig{.plane_kernel = {.kind = RobustKind::huber, .width = 0.0F}}.valid());
  EXPECT_STREQ(to_string(SolveOutcome::converged), "converged");
  EXPECT_STREQ(to_string(SolveOutcome::iteration_limit), "iteration_limit");
  EXPECT_STREQ(to_string(SolveOutcome::degenerate), "degenerate");
  EXPECT_STREQ(to_string(SolveOutcome::too_few_residuals), "too_few_residuals");
  EXPECT_STREQ(to_string(SolveOutcome::unsolvable), "unsolvable");
}

}  // namespace
}  // namespace picolo
