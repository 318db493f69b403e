// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Every analytic Jacobian against central differences at identity, tiny, small, random and
// near-half-turn rotations; and what textbook code gets wrong: points on the line or plane itself.

#include <gtest/gtest.h>

#include <cmath>

#include "picolo/solve/line_plane_residuals.hpp"
#include "problems.hpp"

namespace picolo {
namespace {

Pose3d nudged(const Pose3d& pose, int axis, double step) {
  Tangent3<double> tangent{};
  double* entries[] = {&tangent.rotation_rad.x,  &tangent.rotation_rad.y,
                       &tangent.rotation_rad.z,  &tangent.translation_m.x,
                       &tangent.translation_m.y, &tangent.translation_m.z};
  *entries[axis] = step;
  return perturbed(pose, tangent);
}

template <typename Add>
double cost_at(const Add& add, const Pose3d& pose) {
  NormalEquations6<double> system;
  add(pose, system);
  return system.cost;
}

/// -b is the gradient of the cost; checked against differences of the cost itself.
template <typename Add>
void expect_gradient(const Add& add, const Pose3d& pose, double tolerance) {
  constexpr double kStep = 1e-6;
  NormalEquations6<double> system;
  add(pose, system);
  for (int axis = 0; axis < 6; ++axis) {
    const double numeric =
        (cost_at(add, nudged(pose, axis, kStep)) - cost_at(add, nudged(pose, axis, -kStep))) /
        (2 * kStep);
    const double analytic = -system.b[static_cast<std::size_t>(axis)];
    EXPECT_NEAR(analytic, numeric, tolerance * (1 + std::abs(numeric))) << "axis " << axis;
  }
}

const RobustKernel kKernels[] = {{},
                                 {.kind = RobustKind::huber, .width = 0.3F},
                                 {.kind = RobustKind::geman_mcclure, .width = 0.5F}};

TEST(PlaneResidual, GivenAnyRotationAndKernelThenTheGradientMatchesDifferences) {
  for (const auto& pose : test::poses()) {
    for (const auto& kernel : kKernels) {
      const auto planes = test::scene(pose, 13, 0, 0.3).planes;
      expect_gradient([&](const Pose3d& at,
                          auto& system) { accumulate(std::span{planes}, at, kernel, system); },
                      pose, 1e-7);
    }
  }
}

TEST(LineResidual, GivenAnyRotationKernelAndFormThenTheGradientMatchesDifferences) {
  for (const auto& pose : test::poses()) {
    for (const auto& kernel : kKernels) {
      for (const LineForm form : {LineForm::two_directions, LineForm::distance}) {
        const auto lines = test::scene(pose, 0, 13, 0.3).lines;
        expect_gradient(
            [&](const Pose3d& at, auto& system) {
              accumulate(std::span{lines}, form, at, kernel, system);
            },
            pose, 1e-7);
      }
    }
  }
}

TEST(PlaneResidual, HessianIsTheOuterProductOfTheJacobian) {
  for (const auto& pose : test::poses()) {
    const auto plane = test::scene(pose, 1, 0, 0.3).planes.front();
    const auto residual = [&](const Pose3d& at) {
      return dot(plane.normal, difference(transform(at, plane.point_m), plane.plane_m));
    };
    std::array<double, 6> jacobian{};
    for (int axis = 0; axis < 6; ++axis) {
      jacobian[static_cast<std::size_t>(axis)] =
          (residual(nudged(pose, axis, 1e-6)) - residual(nudged(pose, axis, -1e-6))) / 2e-6;
    }
    NormalEquations6<double> system;
    accumulate(std::span{&plane, 1}, pose, {}, system);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = i; j < 6; ++j) {
        EXPECT_NEAR(system.upper[system.index(i, j)], jacobian[i] * jacobian[j], 1e-6);
      }
    }
  }
}

TEST(LineResidual, GivenTheTwoFormsThenCostAndGradientAgreeAndOnlyTheHessianDiffers) {
  for (const auto& pose : test::poses()) {
    const auto lines = test::scene(pose, 0, 20, 0.3).lines;
    NormalEquations6<double> two;
    NormalEquations6<double> one;
    accumulate(std::span{lines}, LineForm::two_directions, pose, {}, two);
    accumulate(std::span{lines}, LineForm::distance, pose, {}, one);
    EXPECT_NEAR(one.cost, two.cost, 1e-12);
    for (std::size_t i = 0; i < 6; ++i) { EXPECT_NEAR(one.b[i], two.b[i], 1e-11); }
    // Along a line nothing is measured: each point gives rank two, the distance form rank one.
    EXPECT_NEAR(two.upper[15] + two.upper[18] + two.upper[20], 40.0, 1e-10);
    EXPECT_NEAR(one.upper[15] + one.upper[18] + one.upper[20], 20.0, 1e-10);
  }
}

TEST(LineDistance, GivenTheTextbookFormulaThenItAgreesWithTheSolversForm) {
  Random random{17};
  for (int i = 0; i < 100; ++i) {
    const Vector3d a = test::random_vector(random, 5);
    const Vector3d b = test::random_vector(random, 5);
    const Vector3d p = test::random_vector(random, 5);
    const auto textbook = line_distance(p, a, b);
    const auto line = line_residual(p, a, difference(b, a));
    const Vector3d way = difference(p, a);
    EXPECT_NEAR(textbook.distance_m, std::hypot(dot(line.side, way), dot(line.other, way)), 1e-12);
    EXPECT_NEAR(norm(textbook.gradient), 1.0, 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double step) {
        Vector3d q = p;
        (axis == 0 ? q.x : axis == 1 ? q.y : q.z) += step;
        return line_distance(q, a, b).distance_m;
      };
      const double analytic = axis == 0   ? textbook.gradient.x
                              : axis == 1 ? textbook.gradient.y
                                          : textbook.gradient.z;
      EXPECT_NEAR(analytic, (moved(1e-6) - moved(-1e-6)) / 2e-6, 1e-7);
    }
  }
}

TEST(LineDistance, GivenAPointOnTheLineOrNoLineAtAllThenItIsZeroAndFinite) {
  const auto on = line_distance(Vector3d{1, 1, 1}, Vector3d{0, 0, 0}, Vector3d{2, 2, 2});
  EXPECT_EQ(on.distance_m, 0.0);
  EXPECT_EQ(on.gradient, Vector3d{});
  const auto none = line_distance(Vector3d{1, 2, 3}, Vector3d{1, 1, 1}, Vector3d{1, 1, 1});
  EXPECT_EQ(none.distance_m, 0.0);
  EXPECT_EQ(none.gradient, Vector3d{});
}

TEST(Accumulate, GivenZeroResidualsThenEverythingIsFinite) {
  const Pose3d pose{exp_so3(Vector3d{0.1, 0.2, 0.3}), {1, 2, 3}};
  const auto exact = test::scene(pose, 9, 0, 0.0);
  std::vector<LineResidual<double>> lines;
  for (const auto& plane : exact.planes) {  // lines through the very points
    lines.push_back(line_residual(plane.point_m, transform(pose, plane.point_m), plane.normal));
  }
  for (const LineForm form : {LineForm::two_directions, LineForm::distance}) {
    for (const auto& kernel : kKernels) {
      NormalEquations6<double> system;
      accumulate(std::span{exact.planes}, pose, kernel, system);
      accumulate(std::span{lines}, form, pose, kernel, system);
      for (const double entry : system.upper) { EXPECT_TRUE(std::isfinite(entry)); }
      for (const double entry : system.b) { EXPECT_NEAR(entry, 0.0, 1e-12); }
      EXPECT_NEAR(system.cost, 0.0, 1e-24);
    }
  }
}

TEST(LineResidual, SidesAreAnOrthonormalPairForEveryDirection) {
  Random random{29};
  for (int i = 0; i < 200; ++i) {
    Vector3d d = test::random_direction(random);
    if (i < 6) { d = {i % 3 == 0 ? 1.0 : 0.0, i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0}; }
    const auto line = line_residual(Vector3d{}, Vector3d{}, scaled(d, random.uniform(0.01, 100)));
    EXPECT_NEAR(norm(line.side), 1, 1e-14);
    EXPECT_NEAR(norm(line.other), 1, 1e-14);
    EXPECT_NEAR(dot(line.side, line.other), 0, 1e-14);
    EXPECT_NEAR(dot(line.side, d), 0, 1e-14);
    EXPECT_NEAR(dot(line.other, d), 0, 1e-14);
  }
  const auto none = line_residual(Vector3d{1, 2, 3}, Vector3d{}, Vector3d{});
  EXPECT_EQ(none.side, Vector3d{});
}

TEST(RobustKernel, WeightIsTheSlopeOfTheCost) {
  for (const auto& kernel : kKernels) {
    for (const double s : {1e-6, 0.01, 0.0899, 0.2, 1.0, 50.0}) {
      const double h = 1e-6 * s;
      const double slope = (robust_cost(kernel, s + h) - robust_cost(kernel, s - h)) / (2 * h);
      EXPECT_NEAR(robust_weight(kernel, s), slope, 1e-6);
    }
    EXPECT_EQ(robust_weight(kernel, 0.0), 1.0);
    EXPECT_EQ(robust_cost(kernel, 0.0), 0.0);
  }
}

TEST(RobustKernel, GivenAnOutlierThenGemanMcClureForgetsItAndHuberDoesNot) {
  const RobustKernel huber{.kind = RobustKind::huber, .width = 0.1F};
  const RobustKernel bounded{.kind = RobustKind::geman_mcclure, .width = 0.1F};
  EXPECT_NEAR(10.0 * robust_weight(huber, 100.0), 0.1, 1e-7);  // pull stays at the width
  EXPECT_LT(10.0 * robust_weight(bounded, 100.0), 1e-6);
  EXPECT_LT(robust_cost(bounded, 1e6), 0.0101);
}

}  // namespace
}  // namespace picolo
