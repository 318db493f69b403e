// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The group laws of SE(3) for both scalars, and the matrix form against the quaternion form.

#include "picolo/geometry/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

template <typename T>
std::vector<Tangent3<T>> tangents() {
  std::vector<Tangent3<T>> all{{},
                               {{T(1e-8), T(0), T(-1e-8)}, {T(1), T(2), T(3)}},
                               {{T(0), T(0), T(3.1415)}, {T(1), T(-2), T(0.5)}},
                               {{T(0.1), T(0.2), T(-0.1)}, {T(-1), T(0), T(2)}}};
  Random random{23};
  for (int i = 0; i < 100; ++i) {
    Tangent3<T> next;
    for (T* value : {&next.rotation_rad.x, &next.rotation_rad.y, &next.rotation_rad.z}) {
      *value = static_cast<T>(random.uniform(-1.8, 1.8));
    }
    for (T* value : {&next.translation_m.x, &next.translation_m.y, &next.translation_m.z}) {
      *value = static_cast<T>(random.uniform(-5, 5));
    }
    all.push_back(next);
  }
  return all;
}

template <typename T>
class Se3Laws : public ::testing::Test {
 protected:
  static constexpr double tolerance() { return sizeof(T) == 4 ? 1e-5 : 2e-14; }
  static std::vector<Pose3<T>> samples() {
    std::vector<Pose3<T>> all;
    for (const auto& tau : tangents<T>()) { all.push_back(exp_se3(tau)); }
    return all;
  }
  static void expect_same(const Pose3<T>& a, const Pose3<T>& b, double scale = 1.0) {
    EXPECT_LE(rotation_angle_rad(compose(inverse(a.rotation), b.rotation)), scale * tolerance());
    EXPECT_LE(norm(difference(a.translation_m, b.translation_m)), scale * tolerance());
  }
};

using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Se3Laws, Scalars);

TYPED_TEST(Se3Laws, IdentityIsNeutralAndInverseCancels) {
  for (const auto& pose : this->samples()) {
    this->expect_same(pose * Pose3<TypeParam>{}, pose);
    this->expect_same(Pose3<TypeParam>{} * pose, pose);
    this->expect_same(pose * inverse(pose), {});
    this->expect_same(inverse(pose) * pose, {});
  }
}

TYPED_TEST(Se3Laws, CompositionIsAssociative) {
  const auto all = this->samples();
  for (std::size_t i = 0; i + 2 < all.size(); ++i) {
    this->expect_same((all[i] * all[i + 1]) * all[i + 2], all[i] * (all[i + 1] * all[i + 2]), 3.0);
  }
}

TYPED_TEST(Se3Laws, BetweenIsInverseTimesPose) {
  const auto all = this->samples();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    this->expect_same(between(all[i], all[i + 1]), inverse(all[i]) * all[i + 1], 3.0);
  }
}

TYPED_TEST(Se3Laws, ActionIsCompatibleWithComposition) {
  using T = TypeParam;
  const auto all = this->samples();
  const Vector3<T> p{T(1), T(-2), T(0.5)};
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const auto way =
        difference(transform(all[i] * all[i + 1], p), transform(all[i], transform(all[i + 1], p)));
    EXPECT_LE(norm(way), 3 * this->tolerance());
  }
}

TYPED_TEST(Se3Laws, ExpAndLogAreInverse) {
  for (const auto& tau : tangents<TypeParam>()) {
    this->expect_same(exp_se3(log_se3(exp_se3(tau))), exp_se3(tau), 5.0);
    if (norm(tau.rotation_rad) < TypeParam(3)) {
      const auto back = log_se3(exp_se3(tau));
      EXPECT_LE(norm(difference(back.rotation_rad, tau.rotation_rad)), 2 * this->tolerance());
      EXPECT_LE(norm(difference(back.translation_m, tau.translation_m)), 20 * this->tolerance());
    }
  }
}

TYPED_TEST(Se3Laws, AdjointMovesTheTangentAcross) {
  using T = TypeParam;
  const Tangent3<T> tau{{T(0.2), T(-0.1), T(0.3)}, {T(1), T(0.5), T(-0.5)}};
  for (const auto& pose : this->samples()) {
    this->expect_same(pose * exp_se3(tau), exp_se3(adjoint_times(pose, tau)) * pose, 5.0);
  }
}

TYPED_TEST(Se3Laws, InterpolationEndsAreTheEnds) {
  using T = TypeParam;
  const auto all = this->samples();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    this->expect_same(interpolate(all[i], all[i + 1], T(0)), all[i], 3.0);
    this->expect_same(interpolate(all[i], all[i + 1], T(1)), all[i + 1], 3.0);
  }
}

TYPED_TEST(Se3Laws, PerturbationTurnsAboutTheWorldAxesAndShiftsInTheWorld) {
  using T = TypeParam;
  const Tangent3<T> step{{T(0.01), T(-0.02), T(0.03)}, {T(0.1), T(0.2), T(-0.3)}};
  const Vector3<T> p{T(1), T(2), T(3)};
  for (const auto& pose : this->samples()) {
    const auto turned = rotate(exp_so3(step.rotation_rad), rotate(pose.rotation, p));
    const auto wanted = sum(sum(turned, pose.translation_m), step.translation_m);
    EXPECT_LE(norm(difference(transform(perturbed(pose, step), p), wanted)), this->tolerance());
  }
}

TEST(Se3Matrix, GivenQuaternionPosesThenTheMatrixFormAgrees) {
  const auto all = tangents<double>();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Pose3d a = exp_se3(all[i]);
    const Pose3d b = exp_se3(all[i + 1]);
    const Transform3d together = compose(to_transform(a), to_transform(b));
    const Pose3d wanted = a * b;
    EXPECT_LE(rotation_angle_rad(compose(inverse(wanted.rotation), to_pose(together).rotation)),
              1e-14);
    EXPECT_LE(norm(difference(together.translation_m, wanted.translation_m)), 1e-13);
    const Transform3d way = between(to_transform(a), to_transform(b));
    EXPECT_LE(norm(difference(way.translation_m, between(a, b).translation_m)), 1e-13);
    EXPECT_LE(norm(compose(inverse(together), together).translation_m), 1e-13);
  }
}

TEST(Se3, GivenAThousandCompositionsThenTheRotationStaysUnit) {
  const Pose3f step = exp_se3(Tangent3<float>{{0.1F, 0.2F, -0.15F}, {1.0F, 0.0F, 0.0F}});
  Pose3f pose;
  for (int i = 0; i < 1000; ++i) { pose = pose * step; }
  double norm2 = 0;
  for (const float part : {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z}) {
    norm2 += static_cast<double>(part) * static_cast<double>(part);
  }
  EXPECT_NEAR(norm2, 1.0, 1e-6);
}

TEST(Se3, ConversionsBetweenPrecisionsKeepThePose) {
  const Pose3d pose = exp_se3(Tangent3<double>{{0.4, -0.2, 1.0}, {1, 2, 3}});
  const Pose3d back = to_f64(to_f32(pose));
  EXPECT_LE(rotation_angle_rad(compose(inverse(pose.rotation), back.rotation)), 1e-6);
  EXPECT_LE(norm(difference(pose.translation_m, back.translation_m)), 1e-6);
}

}  // namespace
}  // namespace picolo
