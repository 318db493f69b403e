// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The group laws of SO(3), at identity, at tiny, at random and at nearly half-turn rotations, for
// both scalars; and every analytic Jacobian against central differences.

#include "picolo/geometry/so3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

/// Rotation vectors: zero, tiny, both sides of the series' threshold, random, and up to 1e-6 below
/// pi.
template <typename T>
std::vector<Vector3<T>> rotation_vectors() {
  std::vector<Vector3<double>> all{
      {0, 0, 0},        {1e-8, 0, 0},   {1e-8, -1e-8, 1e-8}, {1e-4, 2e-4, 0},
      {0.2, -0.2, 0.1}, {0.2999, 0, 0}, {0.3001, 0, 0},      {0, std::numbers::pi / 2, 0}};
  Random random{5};
  for (int i = 0; i < 120; ++i) {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const double z = random.uniform(-1, 1);
    const double length = std::sqrt(x * x + y * y + z * z);
    const double near_pi = std::numbers::pi - 1e-5 * random.uniform(0.1, 1.0);
    const double angle = i % 3 == 0 ? near_pi : random.uniform(0, 3.1);
    all.push_back({angle * x / length, angle * y / length, angle * z / length});
  }
  std::vector<Vector3<T>> result;
  for (const auto& v : all) {
    result.push_back({static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)});
  }
  return result;
}

template <typename T>
class So3Laws : public ::testing::Test {
 protected:
  static constexpr double tolerance() { return sizeof(T) == 4 ? 2e-6 : 4e-15; }
  static std::vector<Quaternion<T>> samples() {
    std::vector<Quaternion<T>> result;
    for (const auto& w : rotation_vectors<T>()) { result.push_back(exp_so3(w)); }
    return result;
  }
  static void expect_same(const Quaternion<T>& a, const Quaternion<T>& b, double scale = 1.0) {
    const auto angle = static_cast<double>(rotation_angle_rad(compose(inverse(a), b)));
    EXPECT_LE(angle, scale * 2 * tolerance());
  }
  static void expect_near(const Vector3<T>& a, const Vector3<T>& b, double bound) {
    EXPECT_NEAR(a.x, b.x, bound);
    EXPECT_NEAR(a.y, b.y, bound);
    EXPECT_NEAR(a.z, b.z, bound);
  }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(So3Laws, Scalars);

TYPED_TEST(So3Laws, IdentityIsNeutralAndInverseCancels) {
  for (const auto& q : this->samples()) {
    this->expect_same(compose(q, Quaternion<TypeParam>{}), q);
    this->expect_same(compose(Quaternion<TypeParam>{}, q), q);
    this->expect_same(compose(q, inverse(q)), {});
    this->expect_same(compose(inverse(q), q), {});
  }
}

TYPED_TEST(So3Laws, CompositionIsAssociativeAndKeepsUnitNorm) {
  const auto all = this->samples();
  for (std::size_t i = 0; i + 2 < all.size(); ++i) {
    const auto together = compose(compose(all[i], all[i + 1]), all[i + 2]);
    this->expect_same(together, compose(all[i], compose(all[i + 1], all[i + 2])), 2.0);
    double norm2 = 0;
    for (const auto part : {together.w, together.x, together.y, together.z}) {
      norm2 += static_cast<double>(part) * static_cast<double>(part);
    }
    EXPECT_NEAR(norm2, 1.0, 4 * this->tolerance());
  }
}

TYPED_TEST(So3Laws, ActionIsCompatibleWithCompositionAndMatrix) {
  using T = TypeParam;
  const auto all = this->samples();
  const Vector3<T> v{T(1.5), T(-0.5), T(0.25)};
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const auto stepwise = rotate(all[i], rotate(all[i + 1], v));
    this->expect_near(rotate(compose(all[i], all[i + 1]), v), stepwise, 5 * this->tolerance());
    this->expect_near(product(to_matrix(all[i]), v), rotate(all[i], v), 5 * this->tolerance());
    EXPECT_NEAR(norm(rotate(all[i], v)), norm(v), 5 * this->tolerance());
  }
}

TYPED_TEST(So3Laws, MatrixAndQuaternionAreTheSameRotation) {
  for (const auto& q : this->samples()) {
    const auto m = to_matrix(q);
    this->expect_same(from_matrix(m), q, 3.0);
    EXPECT_NEAR(rotation_angle_rad(m), rotation_angle_rad(q), 3 * this->tolerance());
    const auto gram = product(m, transpose(m));
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(gram.elements[i], i % 4 == 0 ? 1.0 : 0.0, 4 * this->tolerance());
    }
  }
}

TYPED_TEST(So3Laws, ExpAndLogAreInverse) {
  for (const auto& w : rotation_vectors<TypeParam>()) {
    this->expect_near(log_so3(exp_so3(w)), w, 5 * this->tolerance());
    const auto q = exp_so3(w);
    this->expect_near(log_so3(Quaternion<TypeParam>{-q.w, -q.x, -q.y, -q.z}), w,
                      5 * this->tolerance());
    EXPECT_NEAR(rotation_angle_rad(q), norm(w), 4 * this->tolerance());
  }
}

TYPED_TEST(So3Laws, LogKeepsRelativeAccuracyOfTinyRotations) {
  using T = TypeParam;
  for (const double exponent : {-6.0, -9.0, -15.0, -18.0}) {
    const T tiny = static_cast<T>(std::pow(10.0, exponent));
    const auto back = log_so3(exp_so3(Vector3<T>{tiny, T(0), -tiny}));
    EXPECT_NEAR(static_cast<double>(back.x) / static_cast<double>(tiny), 1.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(back.z) / static_cast<double>(tiny), -1.0, 1e-6);
  }
}

TYPED_TEST(So3Laws, JacobianTimesItsInverseIsIdentity) {
  for (const auto& w : rotation_vectors<TypeParam>()) {
    const auto both = product(left_jacobian_so3(w), inverse_left_jacobian_so3(w));
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(both.elements[i], i % 4 == 0 ? 1.0 : 0.0, 20 * this->tolerance());
    }
  }
}

TYPED_TEST(So3Laws, InterpolationEndsAreTheEndsAndTheMiddleIsHalfWay) {
  using T = TypeParam;
  const auto all = this->samples();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    this->expect_same(interpolate(all[i], all[i + 1], T(0)), all[i], 5.0);
    this->expect_same(interpolate(all[i], all[i + 1], T(1)), all[i + 1], 5.0);
    const auto middle = interpolate(all[i], all[i + 1], T(0.5));
    const double before = rotation_angle_rad(compose(inverse(all[i]), middle));
    const double after = rotation_angle_rad(compose(inverse(middle), all[i + 1]));
    EXPECT_NEAR(before, after, 20 * this->tolerance());
    EXPECT_LE(before, std::numbers::pi / 2 + 1e-5);
  }
}

TEST(So3, LeftJacobianMatchesDifferences) {
  constexpr double kStep = 1e-6;
  for (const auto& w : rotation_vectors<double>()) {
    const Matrix3d analytic = left_jacobian_so3(w);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto nudged = [&](double step) {
        Vector3d v = w;
        (axis == 0 ? v.x : axis == 1 ? v.y : v.z) += step;
        return exp_so3(v);
      };
      const Vector3d column = log_so3(compose(nudged(kStep), inverse(nudged(-kStep))));
      EXPECT_NEAR(analytic(0, axis), column.x / (2 * kStep), 2e-9);
      EXPECT_NEAR(analytic(1, axis), column.y / (2 * kStep), 2e-9);
      EXPECT_NEAR(analytic(2, axis), column.z / (2 * kStep), 2e-9);
    }
  }
}

TEST(So3, GivenAngleFarBelowRoundingOfTheTraceThenItIsStillFound) {
  Matrix3d m = Matrix3d::identity();
  m(1, 0) = 3e-13;
  m(0, 1) = -3e-13;
  EXPECT_DOUBLE_EQ(rotation_angle_rad(m), 3e-13);
}

TEST(So3, GivenExactHalfTurnsThenFromMatrixFindsTheAxis) {
  EXPECT_EQ(from_matrix(Matrix3d::diagonal(1, -1, -1)).x, 1.0);
  EXPECT_EQ(from_matrix(Matrix3d::diagonal(-1, 1, -1)).y, 1.0);
  EXPECT_EQ(from_matrix(Matrix3d::diagonal(-1, -1, 1)).z, 1.0);
  EXPECT_DOUBLE_EQ(rotation_angle_rad(Matrix3d::diagonal(-1, -1, 1)), std::numbers::pi);
}

TEST(So3, NormalisedRepairsLengthAndSignAndSurvivesNonsense) {
  const Quaterniond q = normalised(Quaterniond{-2, 0, 0, 2});
  EXPECT_DOUBLE_EQ(q.w, std::numbers::sqrt2 / 2);
  EXPECT_DOUBLE_EQ(q.z, -std::numbers::sqrt2 / 2);
  EXPECT_EQ(normalised(Quaterniond{0, 0, 0, 0}), Quaterniond{});
  EXPECT_EQ(normalised(Quaterniond{std::numeric_limits<double>::quiet_NaN(), 0, 0, 0}),
            Quaterniond{});
}

TEST(So3, SkewIsTheCrossProduct) {
  const Vector3d a{1, -2, 3};
  const Vector3d b{0.5, 4, -1};
  EXPECT_EQ(product(skew(a), b), cross(a, b));
  EXPECT_EQ(dot(cross(a, b), a), 0.0);
}

}  // namespace
}  // namespace picolo
