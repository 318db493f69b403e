// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/alignment.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "picolo/evaluation/pose_error.hpp"
#include "scenes.hpp"

namespace picolo {
namespace {

std::vector<Transform3d> moved(const Alignment& by, std::vector<Transform3d> poses) {
  align(by, poses);
  return poses;
}

double largest_error(const std::vector<Transform3d>& a, const std::vector<Transform3d>& b,
                     PoseRelation relation) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, absolute_error(a[i], b[i], relation));
  }
  return largest;
}

TEST(Alignment, GivenAMovedCopyWhenAlignedBySe3ThenNothingIsLeft) {
  for (const double angle : {0.0, 1e-6, 1.0, 3.1, std::numbers::pi}) {
    const auto estimate = test::wandering(50, 1);
    const auto reference =
        moved({test::pose(5, -3, 2, 0.6 * angle, 0.0, 0.8 * angle), 1.0}, estimate);
    const auto found = find_alignment(reference, estimate, AlignmentKind::se3);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->scale, 1.0);
    EXPECT_LT(largest_error(reference, moved(*found, estimate), PoseRelation::full), 1e-12);
  }
}

TEST(Alignment, GivenAScaledCopyWhenAlignedBySim3ThenTheScaleIsFound) {
  const auto estimate = test::wandering(50, 2);
  const auto reference = moved({test::pose(1, 2, 3, 0.4, -0.3, 2.0), 2.5}, estimate);
  const auto found = find_alignment(reference, estimate, AlignmentKind::sim3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->scale, 2.5, 1e-13);
  EXPECT_LT(largest_error(reference, moved(*found, estimate), PoseRelation::full), 1e-12);
}

TEST(Alignment, GivenATurnInThePlaneWhenAlignedBySe2ThenHeightsStay) {
  const auto estimate = test::wandering(50, 3);
  auto reference = moved({test::pose(-4, 7, 0, 0, 0, -2.2), 1.0}, estimate);
  for (auto& pose : reference) { pose.translation_m.z += 0.5; }
  const auto found = find_alignment(reference, estimate, AlignmentKind::se2);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->motion.translation_m.z, 0.0);
  const auto result = moved(*found, estimate);
  for (std::size_t i = 0; i < result.size(); ++i) {
    EXPECT_NEAR(absolute_error(reference[i], result[i], PoseRelation::translation), 0.5, 1e-12);
    EXPECT_EQ(result[i].translation_m.z, estimate[i].translation_m.z);
  }
}

TEST(Alignment, GivenNoiseThenNoSmallMotionImprovesTheSe3Answer) {
  const auto estimate = test::wandering(80, 4);
  auto reference = moved({test::pose(5, -3, 2, 0.6, 0.0, 0.8), 1.0}, estimate);
  Random random{9};
  for (auto& pose : reference) {
    pose.translation_m.x += 0.1 * random.gaussian();
    pose.translation_m.y += 0.1 * random.gaussian();
  }
  const auto cost = [&](const Alignment& by) {
    double sse = 0;
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      const double e =
          absolute_error(reference[i], aligned(by, estimate[i]), PoseRelation::translation);
      sse += e * e;
    }
    return sse;
  };
  for (const bool with_scale : {false, true}) {
    const auto best =
        find_alignment(reference, estimate, with_scale ? AlignmentKind::sim3 : AlignmentKind::se3);
    ASSERT_TRUE(best);
    for (int axis = 0; axis < 6; ++axis) {
      for (const double step : {-1e-4, 1e-4}) {
        const auto at = [&](int wanted) { return axis == wanted ? step : 0.0; };
        const Transform3d nudge = test::pose(at(0), at(1), at(2), at(3), at(4), at(5));
        EXPECT_GT(cost({compose(nudge, best->motion), best->scale}), cost(*best));
      }
    }
    if (with_scale) {
      EXPECT_GT(cost({best->motion, best->scale * 1.0001}), cost(*best));
      EXPECT_GT(cost({best->motion, best->scale * 0.9999}), cost(*best));
    }
  }
}

TEST(Alignment, GivenAMirroredReferenceThenTheAnswerIsStillARotation) {
  const auto estimate = test::wandering(50, 5);
  auto reference = estimate;
  for (auto& pose : reference) { pose.translation_m.z = -pose.translation_m.z; }
  const auto found = find_alignment(reference, estimate, AlignmentKind::se3);
  ASSERT_TRUE(found);
  const Matrix3d gram = product(found->motion.rotation, transpose(found->motion.rotation));
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(gram.elements[i], i % 4 == 0 ? 1.0 : 0.0, 1e-13);
  }
  const Vector3d x = product(found->motion.rotation, Vector3d{1, 0, 0});
  const Vector3d y = product(found->motion.rotation, Vector3d{0, 1, 0});
  EXPECT_NEAR(dot(cross(x, y), product(found->motion.rotation, Vector3d{0, 0, 1})), 1.0, 1e-12);
}

TEST(Alignment, OriginPutsTheFirstPosesOntoEachOther) {
  const auto estimate = test::wandering(10, 6);
  const auto reference = moved({test::pose(1, 1, 1, 0.3, 0.2, 0.1), 1.0}, test::wandering(10, 7));
  const auto found = find_alignment(reference, estimate, AlignmentKind::origin);
  ASSERT_TRUE(found);
  EXPECT_LT(absolute_error(reference[0], aligned(*found, estimate[0]), PoseRelation::full), 1e-14);
}

TEST(Alignment, RefusesWhatDoesNotDetermineTheAnswer) {
  const auto line = test::straight(10);
  EXPECT_EQ(find_alignment(line, line, AlignmentKind::se3).status(), Status::degenerate);
  EXPECT_TRUE(find_alignment(line, line, AlignmentKind::se2));
  const std::vector<Transform3d> still(10);
  EXPECT_EQ(find_alignment(still, still, AlignmentKind::se2).status(), Status::degenerate);
  EXPECT_EQ(find_alignment(still, still, AlignmentKind::sim3).status(), Status::degenerate);
  const auto few = test::wandering(2, 8);
  EXPECT_EQ(find_alignment(few, few, AlignmentKind::se3).status(), Status::invalid_argument);
  EXPECT_EQ(find_alignment(line, few, AlignmentKind::se3).status(), Status::invalid_argument);
  EXPECT_EQ(find_alignment({}, {}, AlignmentKind::origin).status(), Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
