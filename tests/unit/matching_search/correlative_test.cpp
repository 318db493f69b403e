// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The correlative search against a plain triple loop, and what it is for: finding the pose from
// half a metre and thirty degrees away.

#include "picolo/matching/correlative.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "picolo/geometry/angle.hpp"
#include "scene.hpp"

namespace picolo {
namespace {

using test::map_of;
using test::room;
using test::Scan;
using test::scan_from;

constexpr float kDegree = 0.017453293F;

/// One score by the definition, every point looked up in the field.
float score_of(const DistanceFieldView& field, const PointsView& points, const Pose2f& pose,
               std::size_t chosen) {
  const ScoreTable table = make_score_table({}, field.reach_m);
  int sum = 0;
  for (std::size_t k = 0; k < chosen; ++k) {
    const std::size_t i = k * points.size() / chosen;
    const double c = std::cos(static_cast<double>(pose.theta_rad));
    const double s = std::sin(static_cast<double>(pose.theta_rad));
    const auto px = static_cast<double>(points.x_m[i]);
    const auto py = static_cast<double>(points.y_m[i]);
    const double x = static_cast<double>(pose.x_m) + c * px - s * py;
    const double y = static_cast<double>(pose.y_m) + s * px + c * py;
    const auto per_m = static_cast<double>(field.cells_per_m);
    const int column = static_cast<int>(std::floor(x * per_m));
    const int row = static_cast<int>(std::floor(y * per_m));
    if (column < 0 || row < 0 || column >= field.width || row >= field.height) { continue; }
    sum += table[field.cells[row * field.width + column]];
  }
  return static_cast<float>(sum) / (255.0F * static_cast<float>(chosen));
}

class Correlative : public ::testing::Test {
 protected:
  std::unique_ptr<RollingMap<256, 256>> map_ = map_of(room());
  Random random_{7};
  Pose2d truth_{0.63, -0.41, 0.37};
  Scan scan_ = scan_from(room(), truth_, 360, 0.01, random_);
  DistanceFieldView field_ = map_->core().field();
  Pose2f true_pose_ = to_window(map_->core().window(), truth_);
};

TEST_F(Correlative, GivenTheScoreTableThenItFollowsTheGaussianAndEndsAtTheReach) {
  const ScoreTable table = make_score_table({}, 0.5F);
  EXPECT_EQ(table[0], 255);
  EXPECT_EQ(table[102], 155);  // 0.2 m: exp(-1/2) = 0.6065
  EXPECT_EQ(table[204], 35);   // 0.4 m: exp(-2) = 0.1353
  EXPECT_EQ(table[255], 0);
  EXPECT_TRUE(std::is_sorted(table.rbegin(), table.rend()));
}

TEST_F(Correlative, GivenAGuessFarAwayThenTheBestCandidateIsWithinAStepOfTheTruth) {
  for (const Pose2f error : {Pose2f{0.42F, -0.38F, 0.45F}, Pose2f{-0.45F, 0.4F, -0.5F},
                             Pose2f{0.0F, 0.0F, 0.0F}, Pose2f{-0.3F, -0.47F, 0.2F}}) {
    CorrelativeSearch search;
    const Pose2f guess{true_pose_.x_m + error.x_m, true_pose_.y_m + error.y_m,
                       true_pose_.theta_rad + error.theta_rad};
    ASSERT_EQ(search.search(field_, scan_.view(), {.centre = guess}), Status::ok);
    ASSERT_FALSE(search.candidates().empty());
    const PoseCandidate& best = search.candidates()[0];
    EXPECT_NEAR(best.pose.x_m, true_pose_.x_m, 0.08F);
    EXPECT_NEAR(best.pose.y_m, true_pose_.y_m, 0.08F);
    EXPECT_NEAR(wrap_angle(best.pose.theta_rad - true_pose_.theta_rad), 0.0F, 2.0F * kDegree);
    EXPECT_GT(best.score, 0.75F);
  }
}

TEST_F(Correlative, GivenAnyWindowThenTheBestIsTheMaximumOfATripleLoop) {
  Random random{3};
  for (int round = 0; round < 6; ++round) {
    const auto within_30cm = [&] { return static_cast<float>(random.uniform(-0.3, 0.3)); };
    Pose2f centre = true_pose_;
    centre.x_m += within_30cm();
    centre.y_m += within_30cm();
    centre.theta_rad += within_30cm();
    CorrelativeSearch search{{.max_points = 60}};
    ASSERT_EQ(
        search.search(field_, scan_.view(),
                      {.centre = centre, .half_translation_m = 0.3F, .half_rotation_rad = 0.2F}),
        Status::ok);
    float best = 0.0F;
    for (int a = -6; a <= 6; ++a) {
      for (int j = -3; j <= 3; ++j) {
        for (int i = -3; i <= 3; ++i) {
          const Pose2f pose{centre.x_m + 0.1F * static_cast<float>(i),
                            centre.y_m + 0.1F * static_cast<float>(j),
                            centre.theta_rad + 2.0F * kDegree * static_cast<float>(a)};
          best = std::max(best, score_of(field_, scan_.view(), pose, 60));
        }
      }
    }
    // A point on the edge of a cell may fall on either side in another arithmetic.
    EXPECT_NEAR(search.candidates()[0].score, best, 0.01F);
    EXPECT_FLOAT_EQ(search.upper_bound(), search.candidates()[0].score);
  }
}

TEST_F(Correlative, GivenCandidatesThenTheyAreSortedLocalMaximaWithTheirOwnScores) {
  CorrelativeSearch search{{.max_candidates = 8}};
  const Pose2f guess{true_pose_.x_m + 0.2F, true_pose_.y_m, true_pose_.theta_rad};
  ASSERT_EQ(search.search(field_, scan_.view(),
                          {.centre = guess, .half_translation_m = 1.2F, .half_rotation_rad = 1.0F}),
            Status::ok);
  const auto found = search.candidates();
  ASSERT_EQ(found.size(), 8U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i > 0) { EXPECT_LE(found[i].score, found[i - 1].score); }
    EXPECT_NEAR(found[i].score, score_of(field_, scan_.view(), found[i].pose, 96), 0.015F);
    for (std::size_t k = 0; k < i; ++k) {  // two maxima are never neighbours
      const bool apart =
          std::abs(found[i].pose.x_m - found[k].pose.x_m) > 0.15F ||
          std::abs(found[i].pose.y_m - found[k].pose.y_m) > 0.15F ||
          std::abs(wrap_angle(found[i].pose.theta_rad - found[k].pose.theta_rad)) > 3.0F * kDegree;
      EXPECT_TRUE(apart) << i << " and " << k;
    }
  }
}

TEST_F(Correlative, GivenAnySliceThenTheCandidatesAreTheSameBits) {
  const SearchWindow window{
      .centre = {true_pose_.x_m - 0.3F, true_pose_.y_m + 0.2F, true_pose_.theta_rad + 0.2F}};
  CorrelativeSearch whole;
  ASSERT_EQ(whole.search(field_, scan_.view(), window), Status::ok);
  for (const std::size_t slice : {std::size_t{1}, std::size_t{1000}, std::size_t{7777}}) {
    CorrelativeSearch sliced;
    ASSERT_EQ(sliced.begin(field_, scan_.view(), window), Status::ok);
    int slices = 0;
    while (!sliced.step(slice)) {
      ++slices;
      EXPECT_FLOAT_EQ(sliced.upper_bound(), 1.0F);
    }
    EXPECT_GT(slices, 10);
    ASSERT_EQ(sliced.candidates().size(), whole.candidates().size());
    for (std::size_t i = 0; i < whole.candidates().size(); ++i) {
      EXPECT_EQ(sliced.candidates()[i].pose, whole.candidates()[i].pose);
      EXPECT_EQ(sliced.candidates()[i].score, whole.candidates()[i].score);
    }
  }
}

TEST_F(Correlative, GivenAStrongPriorThenItPullsTheAnswerTowardsItself) {
  // A scan of one straight wall: x is open, the prior decides.
  const std::vector<test::Wall> wall{{-6, 2, 6, 2}};
  const auto map = map_of(wall);
  Random random{5};
  Scan scan = scan_from(wall, {0, 0, 0}, 360, 0.0, random);
  for (std::size_t k = 0; k < scan.x_m.size(); ++k) {  // keep what lies well inside of the wall
    if (std::abs(scan.x_m[k]) > 3.0F) { scan.x_m[k] = scan.y_m[k] = 1e6F; }
  }
  const Pose2f centre = to_window(map->core().window(), {0, 0, 0});
  for (const float wanted : {-0.4F, 0.3F}) {
    PosePrior prior;
    prior.pose = {centre.x_m + wanted, centre.y_m, 0.0F};
    prior.information = Matrix3f::diagonal(100.0F, 100.0F, 100.0F);
    CorrelativeSearch search;
    ASSERT_EQ(search.search(map->core().field(), scan.view(), {.centre = centre}, prior),
              Status::ok);
    EXPECT_NEAR(search.candidates()[0].pose.x_m, centre.x_m + wanted, 0.01F);
    EXPECT_NEAR(search.candidates()[0].pose.y_m, centre.y_m, 0.06F);
  }
}

TEST_F(Correlative, GivenPointsOutsideOfTheMapThenTheyScoreNothing) {
  const Scan far{.x_m = {100.0F, -100.0F, 3e9F, std::nanf("")}, .y_m = {0.0F, 0.0F, 0.0F, 0.0F}};
  CorrelativeSearch search;
  ASSERT_EQ(search.search(field_, far.view(), {.centre = true_pose_}), Status::ok);
  EXPECT_TRUE(search.candidates().empty());
  EXPECT_FLOAT_EQ(search.upper_bound(), 0.0F);
}

TEST_F(Correlative, GivenAWindowAtTheEdgeOfTheMapThenOnlyWhatIsInsideCounts) {
  CorrelativeSearch search{{.max_points = 60}};
  const Pose2f corner{0.2F, 0.2F, 0.1F};
  ASSERT_EQ(search.search(field_, scan_.view(), {.centre = corner}), Status::ok);
  for (const PoseCandidate& candidate : search.candidates()) {
    EXPECT_NEAR(candidate.score, score_of(field_, scan_.view(), candidate.pose, 60), 0.02F);
  }
}

TEST_F(Correlative, GivenBadRequestsThenTheyAreRefusedAndThereIsNothingToStep) {
  CorrelativeSearch search;
  EXPECT_EQ(search.begin(field_, {}, {.centre = true_pose_}), Status::degenerate);
  EXPECT_TRUE(search.step(1));
  EXPECT_EQ(search.begin(field_, scan_.view(), {.half_translation_m = 1.3F}), Status::full);
  EXPECT_EQ(search.begin(field_, scan_.view(), {.half_rotation_rad = -1.0F}),
            Status::invalid_argument);
  EXPECT_EQ(search.begin(field_, scan_.view(), {.half_translation_m = std::nanf("")}),
            Status::invalid_argument);
  CorrelativeSearch wrong{{.max_points = 1000}};
  EXPECT_EQ(wrong.begin(field_, scan_.view(), {}), Status::invalid_argument);
  EXPECT_TRUE(wrong.candidates().empty());
}

}  // namespace
}  // namespace picolo
