// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The group laws of SE(2), at identity, at tiny, at random and at nearly half-turn rotations, for
// both scalars; and every analytic Jacobian against central differences.

#include "picolo/geometry/pose2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

template <typename T>
class Se2Laws : public ::testing::Test {
 protected:
  static constexpr double tolerance() { return sizeof(T) == 4 ? 2e-5 : 1e-13; }

  static std::vector<Pose2<T>> samples() {
    std::vector<Pose2<T>> poses{{T(0), T(0), T(0)},
                                {T(1e-8), T(-1e-8), T(1e-8)},
                                {T(1), T(2), T(3.1415)},
                                {T(-3), T(1), T(-3.1415)},
                                {T(0.5), T(-4), T(1.5707963)}};
    Random random{7};
    for (int i = 0; i < 200; ++i) {
      const auto x = static_cast<T>(random.uniform(-10.0, 10.0));
      const auto y = static_cast<T>(random.uniform(-10.0, 10.0));
      const auto theta = static_cast<T>(random.uniform(-3.14, 3.14));
      poses.push_back({x, y, theta});
    }
    return poses;
  }

  static void expect_near(const Pose2<T>& a, const Pose2<T>& b, double scale = 1.0) {
    EXPECT_NEAR(a.x_m, b.x_m, scale * tolerance() * 10);
    EXPECT_NEAR(a.y_m, b.y_m, scale * tolerance() * 10);
    EXPECT_NEAR(wrap_angle(static_cast<double>(a.theta_rad) - static_cast<double>(b.theta_rad)),
                0.0, scale * tolerance());
  }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Se2Laws, Scalars);

TYPED_TEST(Se2Laws, IdentityIsNeutral) {
  for (const auto& pose : this->samples()) {
    this->expect_near(compose(pose, Pose2<TypeParam>{}), pose);
    this->expect_near(compose(Pose2<TypeParam>{}, pose), pose);
  }
}

TYPED_TEST(Se2Laws, InverseCancelsOnBothSides) {
  for (const auto& pose : this->samples()) {
    this->expect_near(compose(pose, inverse(pose)), {});
    this->expect_near(compose(inverse(pose), pose), {});
  }
}

TYPED_TEST(Se2Laws, CompositionIsAssociative) {
  const auto poses = this->samples();
  for (std::size_t i = 0; i + 2 < poses.size(); ++i) {
    this->expect_near((poses[i] * poses[i + 1]) * poses[i + 2],
                      poses[i] * (poses[i + 1] * poses[i + 2]), 3.0);
  }
}

TYPED_TEST(Se2Laws, BetweenIsInverseTimesPose) {
  const auto poses = this->samples();
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    this->expect_near(between(poses[i], poses[i + 1]), inverse(poses[i]) * poses[i + 1], 3.0);
  }
}

TYPED_TEST(Se2Laws, ActionIsCompatibleWithComposition) {
  const auto poses = this->samples();
  const Point2<TypeParam> p{TypeParam(1.5), TypeParam(-0.5)};
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const auto together = transform(poses[i] * poses[i + 1], p);
    const auto stepwise = transform(poses[i], transform(poses[i + 1], p));
    EXPECT_NEAR(together.x_m, stepwise.x_m, 20 * this->tolerance());
    EXPECT_NEAR(together.y_m, stepwise.y_m, 20 * this->tolerance());
  }
}

TYPED_TEST(Se2Laws, ExpAndLogAreInverse) {
  for (const auto& pose : this->samples()) {
    this->expect_near(exp_se2(log_se2(pose)), pose, 20.0);
  }
}

TYPED_TEST(Se2Laws, AdjointMovesTheTangentAcross) {
  for (const auto& pose : this->samples()) {
    const Tangent2<TypeParam> tau{TypeParam(0.2), TypeParam(-0.1), TypeParam(0.3)};
    const Matrix3<TypeParam> ad = adjoint(pose);
    const Tangent2<TypeParam> moved{
        ad(0, 0) * tau.x_m + ad(0, 1) * tau.y_m + ad(0, 2) * tau.theta_rad,
        ad(1, 0) * tau.x_m + ad(1, 1) * tau.y_m + ad(1, 2) * tau.theta_rad, tau.theta_rad};
    this->expect_near(pose * exp_se2(tau), exp_se2(moved) * pose, 10.0);
  }
}

std::vector<Tangent2<double>> tangents() {
  std::vector<Tangent2<double>> all{
      {0, 0, 0}, {1, -2, 1e-8}, {0.3, 0.4, 0.029}, {0.3, 0.4, 0.031}, {1, 2, 3.1}};
  Random random{11};
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(-3, 3);
    const double y = random.uniform(-3, 3);
    const double theta = random.uniform(-3.1, 3.1);
    all.push_back({x, y, theta});
  }
  return all;
}

Tangent2<double> plus(Tangent2<double> tangent, int axis, double step) {
  (axis == 0 ? tangent.x_m : axis == 1 ? tangent.y_m : tangent.theta_rad) += step;
  return tangent;
}

TEST(Se2Jacobians, RightJacobianMatchesDifferences) {
  constexpr double kStep = 1e-6;
  for (const auto& tau : tangents()) {
    const Matrix3d analytic = right_jacobian(tau);
    for (int axis = 0; axis < 3; ++axis) {
      const Tangent2<double> d = log_se2(between(exp_se2(tau), exp_se2(plus(tau, axis, kStep))));
      const Tangent2<double> e = log_se2(between(exp_se2(tau), exp_se2(plus(tau, axis, -kStep))));
      const auto column = static_cast<std::size_t>(axis);
      EXPECT_NEAR(analytic(0, column), (d.x_m - e.x_m) / (2 * kStep), 1e-8);
      EXPECT_NEAR(analytic(1, column), (d.y_m - e.y_m) / (2 * kStep), 1e-8);
      EXPECT_NEAR(analytic(2, column), (d.theta_rad - e.theta_rad) / (2 * kStep), 1e-8);
    }
  }
}

TEST(Se2Jacobians, LeftJacobianIsAdjointTimesRight) {
  for (const auto& tau : tangents()) {
    const Matrix3d expected = product(adjoint(exp_se2(tau)), right_jacobian(tau));
    const Matrix3d actual = left_jacobian(tau);
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(actual.elements[i], expected.elements[i], 1e-12);
    }
  }
}

TEST(Se2Jacobians, CompositionJacobiansMatchDifferences) {
  constexpr double kStep = 1e-6;
  const auto all = tangents();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Pose2d a = exp_se2(all[i]);
    const Pose2d b = exp_se2(all[i + 1]);
    const Matrix3d left = compose_jacobian_left(a, b);
    const Matrix3d right = compose_jacobian_right(a);
    for (int axis = 0; axis < 3; ++axis) {
      const auto nudged = [&](Pose2d pose, double step) {
        (axis == 0 ? pose.x_m : axis == 1 ? pose.y_m : pose.theta_rad) += step;
        return pose;
      };
      const auto column = static_cast<std::size_t>(axis);
      const Pose2d l1 = nudged(a, kStep) * b;
      const Pose2d l0 = nudged(a, -kStep) * b;
      EXPECT_NEAR(left(0, column), (l1.x_m - l0.x_m) / (2 * kStep), 1e-8);
      EXPECT_NEAR(left(1, column), (l1.y_m - l0.y_m) / (2 * kStep), 1e-8);
      EXPECT_NEAR(left(2, column), wrap_angle(l1.theta_rad - l0.theta_rad) / (2 * kStep), 1e-8);
      const Pose2d r1 = a * nudged(b, kStep);
      const Pose2d r0 = a * nudged(b, -kStep);
      EXPECT_NEAR(right(0, column), (r1.x_m - r0.x_m) / (2 * kStep), 1e-8);
      EXPECT_NEAR(right(1, column), (r1.y_m - r0.y_m) / (2 * kStep), 1e-8);
      EXPECT_NEAR(right(2, column), wrap_angle(r1.theta_rad - r0.theta_rad) / (2 * kStep), 1e-8);
    }
  }
}

TEST(Interpolate, TakesTheShortestArcAcrossTheSeam) {
  const Pose2d middle = interpolate(Pose2d{0, 0, 3.0}, Pose2d{2, 4, -3.0}, 0.5);
  EXPECT_DOUBLE_EQ(middle.x_m, 1.0);
  EXPECT_DOUBLE_EQ(middle.y_m, 2.0);
  EXPECT_NEAR(std::abs(middle.theta_rad), 3.14159265358979, 1e-12);
}

TEST(Interpolate, EndsAreExact) {
  const Pose2d a{1, 2, 0.3};
  const Pose2d b{-1, 5, 2.9};
  EXPECT_EQ(interpolate(a, b, 0.0), a);
  EXPECT_EQ(interpolate(a, b, 1.0), b);
}

TEST(WrapAngle, StaysInsideAndKeepsTheDirection) {
  Random random{3};
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-1000.0, 1000.0);
    const double wrapped = wrap_angle(angle);
    EXPECT_LE(std::abs(wrapped), 3.14159265358979324);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-11);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-11);
    const auto single = static_cast<float>(random.uniform(-1000.0, 1000.0));
    EXPECT_LE(std::abs(wrap_angle(single)), 3.1415927F);
    EXPECT_NEAR(std::sin(wrap_angle(single)), std::sin(single), 2e-4);
  }
}

}  // namespace
}  // namespace picolo
