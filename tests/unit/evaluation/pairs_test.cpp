// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Which pairs an RPE takes, which poses belong together by stamp, and the errors themselves.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "picolo/evaluation/association.hpp"
#include "picolo/evaluation/delta_pairs.hpp"
#include "picolo/evaluation/pose_error.hpp"
#include "scenes.hpp"

namespace picolo {
namespace {

using Pairs = std::vector<IndexPair>;

Pairs select(const std::vector<Transform3d>& poses, const DeltaConfig& config) {
  std::vector<double> path_m(poses.size());
  Pairs pairs(poses.size() * poses.size());
  const auto count = select_pairs(poses, config, path_m, pairs);
  EXPECT_TRUE(count);
  pairs.resize(*count);
  return pairs;
}

TEST(SelectPairs, ByFrames) {
  const auto poses = test::straight(7);
  EXPECT_EQ(select(poses, {.delta = 3}), (Pairs{{0, 3}, {3, 6}}));
  EXPECT_EQ(select(poses, {.delta = 5, .all_pairs = true}), (Pairs{{0, 5}, {1, 6}}));
  EXPECT_EQ(select(poses, {.delta = 7}), Pairs{});
}

TEST(SelectPairs, ByMetresConsecutiveBeginsWhereTheFirstDeltaEnds) {
  EXPECT_EQ(select(test::straight(8), {.delta = 2, .unit = DeltaUnit::metres}),
            (Pairs{{2, 4}, {4, 6}}));
}

TEST(SelectPairs, ByMetresAllTakesTheNearestPartnerWithinTolerance) {
  const DeltaConfig config{.delta = 2.1, .unit = DeltaUnit::metres, .all_pairs = true};
  EXPECT_EQ(select(test::straight(5), config), (Pairs{{0, 2}, {1, 3}, {2, 4}}));
  const DeltaConfig strict{
      .delta = 2.1, .unit = DeltaUnit::metres, .all_pairs = true, .relative_tolerance = 0.01};
  EXPECT_EQ(select(test::straight(5), strict), Pairs{});
}

TEST(SelectPairs, ByMetresAllPrefersTheFirstOfPosesAtRest) {
  auto poses = test::straight(3);
  poses.push_back(poses.back());
  poses.push_back(poses.back());
  const DeltaConfig config{.delta = 1, .unit = DeltaUnit::metres, .all_pairs = true};
  EXPECT_EQ(select(poses, config), (Pairs{{0, 1}, {1, 2}}));
}

TEST(SelectPairs, ByMetresAllAgreesWithTryingEveryPartner) {
  const auto poses = test::wandering(200, 11);
  std::vector<double> path_m(poses.size());
  ASSERT_EQ(accumulate_path(poses, path_m), Status::ok);
  Pairs wanted;
  for (std::uint32_t i = 0; i + 1 < poses.size(); ++i) {
    std::uint32_t best = i + 1;
    for (std::uint32_t j = i + 1; j < poses.size(); ++j) {
      if (std::abs(path_m[j] - path_m[i] - 3.0) < std::abs(path_m[best] - path_m[i] - 3.0)) {
        best = j;
      }
    }
    if (std::abs(path_m[best] - path_m[i] - 3.0) <= 0.3) { wanted.push_back({i, best}); }
  }
  EXPECT_EQ(select(poses, {.delta = 3, .unit = DeltaUnit::metres, .all_pairs = true}), wanted);
  EXPECT_GT(wanted.size(), 150U);
}

TEST(SelectPairs, ByAngle) {
  std::vector<Transform3d> poses;
  for (int i = 0; i < 7; ++i) {
    poses.push_back(test::pose(0, 0, 0, 0, 0, i * 10 * std::numbers::pi / 180));
  }
  EXPECT_EQ(select(poses, {.delta = 19.9, .unit = DeltaUnit::degrees}),
            (Pairs{{0, 2}, {2, 4}, {4, 6}}));
  const DeltaConfig all{.delta = 0.9, .unit = DeltaUnit::radians, .all_pairs = true};
  EXPECT_EQ(select(poses, all), (Pairs{{0, 5}, {1, 6}}));
}

TEST(SelectPairs, RefusesBadConfigurationsAndShortStorage) {
  const auto poses = test::straight(10);
  Pairs pairs(10);
  EXPECT_EQ(select_pairs(poses, {.delta = 0}, {}, pairs).status(), Status::invalid_argument);
  EXPECT_EQ(select_pairs(poses, {.delta = 0.5}, {}, pairs).status(), Status::invalid_argument);
  const DeltaConfig metres{.delta = 1, .unit = DeltaUnit::metres, .all_pairs = true};
  EXPECT_EQ(select_pairs(poses, metres, {}, pairs).status(), Status::invalid_argument);
  pairs.resize(2);
  EXPECT_EQ(select_pairs(poses, {.delta = 1}, {}, pairs).status(), Status::full);
}

TEST(Associate, TakesTheNearestStampOfTheLongerTrajectory) {
  const std::vector<double> reference{0.0, 0.1, 0.2, 0.3, 0.4};
  const std::vector<double> estimate{0.104, 0.26, 0.299, 0.5};
  Pairs pairs(4);
  const auto count = associate(reference, estimate, 0.01, 0.0, pairs);
  ASSERT_TRUE(count);
  pairs.resize(*count);
  EXPECT_EQ(pairs, (Pairs{{1, 0}, {3, 2}}));
}

TEST(Associate, GivenALongerEstimateThenEveryReferenceStampIsServedOnce) {
  const std::vector<double> reference{1.0, 2.0};
  const std::vector<double> estimate{0.5, 1.5, 2.5, 3.5};
  Pairs pairs(2);
  EXPECT_EQ(*associate(reference, estimate, 0.01, -0.5, pairs), 2U);
  EXPECT_EQ(pairs, (Pairs{{0, 1}, {1, 2}}));
}

TEST(Associate, OnATieTheEarlierStampIsTaken) {
  const std::vector<double> reference{0.0, 1.0, 1.0, 2.0};
  const std::vector<double> estimate{0.5, 1.0};
  Pairs pairs(2);
  EXPECT_EQ(*associate(reference, estimate, 0.5, 0.0, pairs), 2U);
  EXPECT_EQ(pairs, (Pairs{{0, 0}, {1, 1}}));
}

TEST(Associate, RefusesDecreasingStampsAndReportsFullStorage) {
  const std::vector<double> good{0, 1, 2};
  const std::vector<double> bad{0, 2, 1};
  Pairs pairs(3);
  EXPECT_EQ(associate(good, bad, 0.1, 0, pairs).status(), Status::invalid_argument);
  EXPECT_EQ(associate(bad, good, 0.1, 0, pairs).status(), Status::invalid_argument);
  EXPECT_EQ(associate(good, good, -1, 0, pairs).status(), Status::invalid_argument);
  pairs.resize(2);
  EXPECT_EQ(associate(good, good, 0.1, 0, pairs).status(), Status::full);
  EXPECT_EQ(*associate({}, good, 0.1, 0, pairs), 0U);
  EXPECT_EQ(*associate({}, {}, 0.1, 0, pairs), 0U);
}

TEST(PoseAt, InterpolatesInsideAndNeverOutside) {
  const std::vector<double> stamps{1.0, 2.0, 4.0};
  const std::vector<Transform3d> poses{test::pose(0, 0, 0), test::pose(2, 0, 0, 0, 0, 1),
                                       test::pose(2, 2, 0, 0, 0, 1)};
  const auto middle = pose_at(stamps, poses, 1.25);
  ASSERT_TRUE(middle);
  EXPECT_LT(absolute_error(*middle, test::pose(0.5, 0, 0, 0, 0, 0.25), PoseRelation::full), 1e-14);
  EXPECT_EQ(*pose_at(stamps, poses, 2.0), poses[1]);
  EXPECT_EQ(*pose_at(stamps, poses, 4.0), poses[2]);
  EXPECT_EQ(pose_at(stamps, poses, 0.99).status(), Status::out_of_range);
  EXPECT_EQ(pose_at(stamps, poses, 4.01).status(), Status::out_of_range);
  EXPECT_EQ(pose_at({}, {}, 0).status(), Status::out_of_range);
  EXPECT_EQ(pose_at(stamps, {}, 1).status(), Status::invalid_argument);
}

TEST(PoseError, RelationsMeasureWhatTheyName) {
  const Transform3d reference = test::pose(1, 2, 3, 0.1, 0.2, 0.3);
  const Transform3d estimate = compose(reference, test::pose(3, 4, 0, 0, 0, 0.5));
  EXPECT_NEAR(absolute_error(reference, estimate, PoseRelation::translation), 5.0, 1e-12);
  EXPECT_NEAR(absolute_error(reference, estimate, PoseRelation::rotation_rad), 0.5, 1e-14);
  EXPECT_NEAR(absolute_error(reference, estimate, PoseRelation::rotation_deg),
              0.5 * 180 / std::numbers::pi, 1e-12);
  const double turn = 4 * (1 - std::cos(0.5));  // squared Frobenius norm of Rz - I
  EXPECT_NEAR(absolute_error(reference, estimate, PoseRelation::full), std::sqrt(turn + 25), 1e-12);
}

TEST(PoseError, RelativeErrorIgnoresWhereTheTrajectoriesAre) {
  const auto reference = test::wandering(30, 12);
  auto estimate = test::wandering(30, 13);
  const double before =
      relative_error(reference[3], reference[9], estimate[3], estimate[9], PoseRelation::full);
  const Transform3d elsewhere = test::pose(10, -5, 2, 1, 0, -1);
  for (auto& pose : estimate) { pose = compose(elsewhere, pose); }
  EXPECT_NEAR(
      relative_error(reference[3], reference[9], estimate[3], estimate[9], PoseRelation::full),
      before, 1e-12);
}

TEST(PoseError, RefusesSpansThatDoNotFit) {
  const auto poses = test::straight(3);
  std::vector<double> errors(2);
  EXPECT_EQ(absolute_errors(poses, poses, PoseRelation::full, errors), Status::invalid_argument);
  EXPECT_EQ(absolute_errors({}, {}, PoseRelation::full, {}), Status::invalid_argument);
  EXPECT_EQ(relative_errors(poses, poses, Pairs{{0, 1}}, PoseRelation::full, errors),
            Status::invalid_argument);
  EXPECT_EQ(relative_errors(poses, poses, Pairs{{0, 1}, {1, 3}}, PoseRelation::full, errors),
            Status::out_of_range);
  EXPECT_EQ(relative_errors(poses, poses, Pairs{{0, 1}, {1, 2}}, PoseRelation::full, errors),
            Status::ok);
}

}  // namespace
}  // namespace picolo
