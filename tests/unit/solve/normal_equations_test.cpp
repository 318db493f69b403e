// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/normal_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

Matrix3f random_spd(Random& random) {
  Matrix3f a;
  for (float& element : a.elements) { element = static_cast<float>(random.uniform(-2.0, 2.0)); }
  return sum(product(a, transpose(a)), Matrix3f::diagonal(0.5F, 0.5F, 0.5F));
}

TEST(NormalEquations, SolutionSatisfiesTheEquations) {
  Random random{1};
  for (int i = 0; i < 200; ++i) {
    NormalEquations3 system{random_spd(random), {}};
    for (float& b : system.b) { b = static_cast<float>(random.uniform(-5.0, 5.0)); }
    const StepSolution solution = solve(system);
    ASSERT_TRUE(solution.solved);
    for (std::size_t row = 0; row < 3; ++row) {
      const float left = system.h(row, 0) * solution.step[0] + system.h(row, 1) * solution.step[1] +
                         system.h(row, 2) * solution.step[2];
      EXPECT_NEAR(left, system.b[row], 1e-4F * (1.0F + std::abs(system.b[row])));
    }
  }
}

TEST(NormalEquations, SingularIndefiniteAndNonFiniteAreNotSolved) {
  EXPECT_FALSE(solve({Matrix3f{}, {1, 1, 1}}).solved);
  EXPECT_FALSE(solve({Matrix3f::diagonal(1, 1, 0), {1, 1, 1}}).solved);
  EXPECT_FALSE(solve({Matrix3f::diagonal(1, -1, 1), {1, 1, 1}}).solved);
  EXPECT_FALSE(
      solve({Matrix3f::diagonal(1, std::numeric_limits<float>::quiet_NaN(), 1), {1, 1, 1}}).solved);
}

TEST(Conditioning, EigenvaluesOfADiagonalAreItsEntriesWithThetaScaled) {
  const Conditioning c = conditioning_of(Matrix3f::diagonal(9.0F, 4.0F, 100.0F), 10.0F);
  EXPECT_NEAR(c.eigenvalues[0], 1.0F, 1e-5F);
  EXPECT_NEAR(c.eigenvalues[1], 4.0F, 1e-5F);
  EXPECT_NEAR(c.eigenvalues[2], 9.0F, 1e-5F);
  EXPECT_NEAR(c.condition, 9.0F, 1e-4F);
}

TEST(Conditioning, SingularHasInfiniteCondition) {
  EXPECT_TRUE(std::isinf(conditioning_of(Matrix3f::diagonal(1.0F, 0.0F, 1.0F), 1.0F).condition));
  EXPECT_TRUE(
      std::isinf(conditioning_of(Matrix3f::diagonal(std::nanf(""), 1.0F, 1.0F), 1.0F).condition));
}

TEST(Conditioning, ConstrainedSolutionHasNoPartAlongAWeakDirection) {
  // Information along (cos, sin) only, plus rotation: the weak direction is (-sin, cos).
  const float c = std::cos(0.4F);
  const float s = std::sin(0.4F);
  const Matrix3f h{{100 * c * c, 100 * c * s, 0, 100 * c * s, 100 * s * s + 1e-3F, 0, 0, 0, 50}};
  const Conditioning conditioning = conditioning_of(h, 1.0F);
  EXPECT_GT(conditioning.condition, 1000.0F);
  const StepSolution solution =
      solve_constrained({h, {100 * c, 100 * s, 5}}, conditioning, 1.0F, 1000.0F);
  ASSERT_TRUE(solution.solved);
  EXPECT_NEAR(solution.step[0], c, 1e-3F);
  EXPECT_NEAR(solution.step[1], s, 1e-3F);
  EXPECT_NEAR(solution.step[2], 0.1F, 1e-4F);
}

TEST(Conditioning, ObservablePartIsSilentAboutAWeakDirectionAndKeepsTheRest) {
  const float c = std::cos(0.4F);
  const float s = std::sin(0.4F);
  const float weak = 0.5F;  // of 100
  const Matrix3f h{{100 * c * c + weak * s * s, (100 - weak) * c * s, 0, (100 - weak) * c * s,
                    100 * s * s + weak * c * c, 0, 0, 0, 400}};
  const NormalEquations3 system{h, {100 * c - 3 * s, 100 * s + 3 * c, 8}};
  const Conditioning conditioning = conditioning_of(h, 2.0F);
  EXPECT_EQ(open_directions(conditioning, 100.0F), 1);
  EXPECT_EQ(open_directions(conditioning, 300.0F), 0);
  const NormalEquations3 part = observable_part(system, conditioning, 2.0F, 100.0F);
  EXPECT_NEAR(part.h(0, 0), 100 * c * c, 1e-3F);
  EXPECT_NEAR(part.h(0, 1), 100 * c * s, 1e-3F);
  EXPECT_NEAR(part.h(1, 1), 100 * s * s, 1e-3F);
  EXPECT_NEAR(part.h(2, 2), 400.0F, 1e-2F);
  EXPECT_NEAR(part.b[0], 100 * c, 1e-3F);
  EXPECT_NEAR(part.b[1], 100 * s, 1e-3F);
  EXPECT_NEAR(part.b[2], 8.0F, 1e-4F);
  const NormalEquations3 whole = observable_part(system, conditioning, 2.0F, 300.0F);
  for (std::size_t k = 0; k < 9; ++k) { EXPECT_NEAR(whole.h.elements[k], h.elements[k], 2e-3F); }
  EXPECT_EQ(open_directions(conditioning_of(Matrix3f{}, 1.0F), 100.0F), 3);
}

TEST(Conditioning, ConstrainedEqualsFullSolutionWhenEverythingIsObserved) {
  Random random{4};
  for (int i = 0; i < 50; ++i) {
    const NormalEquations3 system{random_spd(random), {1.0F, -2.0F, 0.5F}};
    const Conditioning conditioning = conditioning_of(system.h, 2.0F);
    const StepSolution full = solve(system);
    const StepSolution constrained = solve_constrained(system, conditioning, 2.0F, 1e6F);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(full.step[k], constrained.step[k], 2e-3F * (1.0F + std::abs(full.step[k])));
    }
  }
}

TEST(Covariance, IsTheInverseOrTheStatedUnknown) {
  Random random{9};
  const Matrix3f h = random_spd(random);
  const Matrix3f identity = product(h, covariance_of(h, 1e3F));
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      EXPECT_NEAR(identity(row, column), row == column ? 1.0F : 0.0F, 1e-4F);
    }
  }
  EXPECT_EQ(covariance_of(Matrix3f{}, 7.0F), Matrix3f::diagonal(7.0F, 7.0F, 7.0F));
}

}  // namespace
}  // namespace picolo
