// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The closed form on exact, noisy, flat and mirrored sets, in the plane and in space.

#include "picolo/matching/point_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

std::vector<Point2<double>> cloud_2d(Random& random, int count) {
  std::vector<Point2<double>> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-5, 5);
    points.push_back({x, random.uniform(-3, 4)});
  }
  return points;
}

std::vector<Vector3d> cloud_3d(Random& random, int count, double depth) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-5, 5);
    const double y = random.uniform(-3, 4);
    points.push_back({x, y, depth * random.uniform(-1, 1)});
  }
  return points;
}

double determinant(const Matrix3d& m) {
  return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
         m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
         m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}

Vector3d applied(const Transform3d& t, const Vector3d& p) {
  const Matrix3d& r = t.rotation;
  return {r(0, 0) * p.x + r(0, 1) * p.y + r(0, 2) * p.z + t.translation_m.x,
          r(1, 0) * p.x + r(1, 1) * p.y + r(1, 2) * p.z + t.translation_m.y,
          r(2, 0) * p.x + r(2, 1) * p.y + r(2, 2) * p.z + t.translation_m.z};
}

double squared_error(const Transform3d& t, const std::vector<Vector3d>& a,
                     const std::vector<Vector3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3d p = applied(t, b[i]);
    sum += (p.x - a[i].x) * (p.x - a[i].x) + (p.y - a[i].y) * (p.y - a[i].y) +
           (p.z - a[i].z) * (p.z - a[i].z);
  }
  return sum;
}

TEST(AlignPoints2d, GivenAnyMotionThenItIsFoundToTheLastDigits) {
  Random random{1};
  for (int i = 0; i < 200; ++i) {
    const Pose2d truth{random.uniform(-10, 10), random.uniform(-10, 10),
                       random.uniform(-3.14, 3.14)};
    const auto b = cloud_2d(random, 2 + i % 20);
    std::vector<Point2<double>> a;
    for (const auto& p : b) { a.push_back(transform(truth, p)); }
    const auto found = align_points(a, b);
    ASSERT_TRUE(found);
    EXPECT_NEAR((*found).x_m, truth.x_m, 1e-9);
    EXPECT_NEAR((*found).y_m, truth.y_m, 1e-9);
    EXPECT_NEAR(wrap_angle((*found).theta_rad - truth.theta_rad), 0.0, 1e-10);
  }
}

TEST(AlignPoints2d, GivenNoiseThenNoMotionNearbyIsBetter) {
  Random random{2};
  const auto b = cloud_2d(random, 30);
  std::vector<Point2<double>> a;
  for (const auto& p : b) {
    Point2<double> moved = transform(Pose2d{1, 2, 0.5}, p);
    moved.x_m += 0.2 * random.gaussian();
    moved.y_m += 0.2 * random.gaussian();
    a.push_back(moved);
  }
  const auto found = align_points(a, b);
  ASSERT_TRUE(found);
  const auto error = [&](const Pose2d& pose) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Point2<double> p = transform(pose, b[i]);
      sum += (p.x_m - a[i].x_m) * (p.x_m - a[i].x_m) + (p.y_m - a[i].y_m) * (p.y_m - a[i].y_m);
    }
    return sum;
  };
  const double best = error(*found);
  for (const double d : {-1e-3, 1e-3}) {
    EXPECT_GT(error({(*found).x_m + d, (*found).y_m, (*found).theta_rad}), best);
    EXPECT_GT(error({(*found).x_m, (*found).y_m + d, (*found).theta_rad}), best);
    EXPECT_GT(error({(*found).x_m, (*found).y_m, (*found).theta_rad + d}), best);
  }
}

TEST(AlignPoints2d, GivenAMirroredSetThenTheAnswerIsStillARotation) {
  // Without the sign fix the best orthogonal matrix is the mirror image, and its "yaw" nonsense.
  const std::vector<Point2<double>> b{{2, 0}, {-2, 0}, {0, 1}, {0, -1}};
  std::vector<Point2<double>> a;
  for (const auto& p : b) { a.push_back({p.x_m, -p.y_m}); }
  const auto found = align_points(a, b);
  ASSERT_TRUE(found);
  EXPECT_NEAR((*found).theta_rad, 0.0, 1e-12) << "the long axis must win";
  EXPECT_NEAR((*found).x_m, 0.0, 1e-12);
}

TEST(AlignPoints2d, GivenWhatDoesNotDetermineAMotionThenItIsRefused) {
  const std::vector<Point2<double>> one{{1, 2}};
  const std::vector<Point2<double>> two{{1, 2}, {3, 4}};
  const std::vector<Point2<double>> same{{1, 2}, {1, 2}, {1, 2}};
  EXPECT_EQ(align_points(std::span{one}, std::span{one}).status(), Status::invalid_argument);
  EXPECT_EQ(align_points(std::span{one}, std::span{two}).status(), Status::invalid_argument);
  EXPECT_EQ(align_points(std::span{same}, std::span{same}).status(), Status::degenerate);
  const std::vector<Point2<double>> bad{{1, 2}, {std::numeric_limits<double>::quiet_NaN(), 4}};
  EXPECT_EQ(align_points(std::span{two}, std::span{bad}).status(), Status::degenerate);
}

TEST(AlignPoints3d, GivenAnyMotionThenItIsFoundAlsoForFlatSets) {
  Random random{3};
  for (int i = 0; i < 200; ++i) {
    const Tangent3<double> tangent{
        {random.uniform(-1.8, 1.8), random.uniform(-1.8, 1.8), random.uniform(-1.8, 1.8)},
        {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)}};
    const Pose3d truth = exp_se3(tangent);
    const auto b = cloud_3d(random, 3 + i % 20, i % 3 == 0 ? 0.0 : 2.0);  // every third is flat
    std::vector<Vector3d> a;
    for (const auto& p : b) { a.push_back(transform(truth, p)); }
    const auto found = align_points(a, b);
    ASSERT_TRUE(found);
    EXPECT_NEAR(determinant((*found).rotation), 1.0, 1e-9);
    EXPECT_LT(squared_error(*found, a, b), 1e-16);
    const Transform3d expected = to_transform(truth);
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_NEAR((*found).rotation.elements[k], expected.rotation.elements[k], 1e-8);
    }
  }
}

TEST(AlignPoints3d, GivenAMirroredSetThenTheAnswerIsTheBestRotation) {
  Random random{4};
  const auto b = cloud_3d(random, 40, 0.3);
  std::vector<Vector3d> a;
  for (const auto& p : b) { a.push_back({p.x, p.y, -p.z}); }
  const auto found = align_points(a, b);
  ASSERT_TRUE(found);
  EXPECT_NEAR(determinant((*found).rotation), 1.0, 1e-9);
  const double best = squared_error(*found, a, b);
  for (int i = 0; i < 50; ++i) {
    const Pose3d nearby = exp_se3(Tangent3<double>{
        {0.01 * random.gaussian(), 0.01 * random.gaussian(), 0.01 * random.gaussian()}, {}});
    EXPECT_GE(squared_error(compose(*found, to_transform(nearby)), a, b), best);
  }
}

TEST(AlignPoints3d, GivenPointsOnALineThenTheRotationAboutItIsUnknownAndItIsRefused) {
  std::vector<Vector3d> line;
  for (int i = 0; i < 10; ++i) { line.push_back({0.1 * i, 0.2 * i, -0.3 * i}); }
  EXPECT_EQ(align_points(std::span{line}, std::span{line}).status(), Status::degenerate);
  const std::vector<Vector3d> two{{1, 2, 3}, {3, 4, 5}};
  EXPECT_EQ(align_points(std::span{two}, std::span{two}).status(), Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
