// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Branch and bound over poses equals brute force, exactly, and finds a kidnapped vehicle.

#include "picolo/matching/pose_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "picolo/geometry/angle.hpp"
#include "scene.hpp"
#include "support/property.hpp"

namespace picolo {
namespace {

using test::map_of;
using test::room;
using test::Scan;
using test::scan_from;

constexpr float kDegree = 0.017453293F;

struct Ground {
  std::unique_ptr<RollingMap<256, 256>> map = map_of(room());
  MaxPyramid<256, 256, 2> pyramid;
  Random random{21};
  Pose2d truth{-1.17, 0.83, 2.1};
  Scan scan = scan_from(room(), truth, 360, 0.01, random);
  Pose2f true_pose = to_window(map->core().window(), truth);

  Ground() {
    pyramid.core().begin(map->core().field());
    static_cast<void>(pyramid.core().step(1 << 20));
  }
};

/// Every leaf of the window, scored by the very same function.
std::int32_t brute_force(const Ground& ground, const PosePrior& prior, const SearchWindow& window,
                         const PoseSearchConfig& config, std::size_t points,
                         const PoseSearchArea& area = {}, const PoseExclusion& excluded = {}) {
  PoseTree tree;
  tree.begin(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(), points, window,
             prior, config, area);
  tree.exclude(excluded);
  std::int32_t best = 0;
  for (int a = -tree.half_angles(); a <= tree.half_angles(); ++a) {
    for (int y = -tree.half_cells(); y <= tree.half_cells(); ++y) {
      for (int x = -tree.half_cells(); x <= tree.half_cells(); ++x) {
        const PoseNode leaf{0, static_cast<std::int16_t>(a), -1, static_cast<std::int16_t>(x),
                            static_cast<std::int16_t>(y)};
        best = std::max(best, tree.bound_of(leaf));
      }
    }
  }
  return best;
}

float unit(std::size_t points) {
  return 1.0F / (255.0F * static_cast<float>(points));
}

RC_GTEST_PROP(PoseSearch, EqualsBruteForceInEveryWindow, ()) {
  static const Ground ground;  // NOLINT: built once, never changed
  const auto within = [](float half) {
    return static_cast<float>(*rc::gen::inRange(-1000, 1001)) * 0.001F * half;
  };
  const SearchWindow window{
      .centre = {ground.true_pose.x_m + within(5.0F), ground.true_pose.y_m + within(5.0F),
                 within(3.1F)},
      .half_translation_m = 0.05F + static_cast<float>(*rc::gen::inRange(0, 50)) * 0.01F,
      .half_rotation_rad = static_cast<float>(*rc::gen::inRange(0, 8)) * kDegree};
  PosePrior prior;
  if (*rc::gen::arbitrary<bool>()) {
    prior.pose = {window.centre.x_m + within(0.5F), window.centre.y_m + within(0.5F),
                  window.centre.theta_rad + within(0.2F)};
    prior.information = Matrix3f::diagonal(within(20.0F) + 20.0F, within(20.0F) + 20.0F, 30.0F);
  }
  const std::size_t points = *rc::gen::inRange<std::size_t>(1, 40);
  const PoseSearchConfig config{
      .max_points = static_cast<int>(points),
      .order = *rc::gen::arbitrary<bool>() ? ChildOrder::best_first : ChildOrder::index};
  PoseSearch search{config};
  RC_ASSERT(search.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(),
                          window, prior) == Status::ok);
  const PoseSearchReport report = search.report();
  const std::int32_t expected = brute_force(ground, prior, window, config, points);
  RC_ASSERT(report.exact);
  RC_ASSERT(report.found == (expected > 0));
  RC_ASSERT(report.upper_bound == static_cast<float>(expected) * unit(points));
  if (report.found) { RC_ASSERT(report.best.score == static_cast<float>(expected) * unit(points)); }
}

RC_GTEST_PROP(PoseSearch, EqualsBruteForceInAnAreaAndElsewhere, ()) {
  static const Ground ground;     // NOLINT: built once, never changed
  constexpr int kAreaCells = 16;  // of 16 cells of the field, of which it has 256
  std::array<std::int8_t, static_cast<std::size_t>(kAreaCells) * kAreaCells> area_cells{};
  for (std::int8_t& cell : area_cells) {
    cell = *rc::gen::element<std::int8_t>(-10, 0, 0, 0, 0, 0, 0, 40);
  }
  const PoseSearchArea area{.log_odds = area_cells.data(),
                            .width = kAreaCells,
                            .height = kAreaCells,
                            .shift = 4,
                            .offset_x = *rc::gen::inRange(-20, 20),
                            .offset_y = *rc::gen::inRange(-20, 20)};
  const auto within = [](float half) {
    return static_cast<float>(*rc::gen::inRange(-1000, 1001)) * 0.001F * half;
  };
  const SearchWindow window{
      .centre = {6.4F + within(4.0F), 6.4F + within(4.0F), ground.true_pose.theta_rad},
      .half_translation_m = 0.8F,
      .half_rotation_rad = 2.0F * kDegree};
  constexpr std::size_t kPoints = 20;
  const PoseSearchConfig config{.max_points = static_cast<int>(kPoints)};
  PoseSearch search{config};
  RC_ASSERT(search.begin(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(),
                         window, {}, area) == Status::ok);
  while (!search.step(1000)) {}
  const std::int32_t best = brute_force(ground, {}, window, config, kPoints, area);
  RC_ASSERT(search.report().exact);
  RC_ASSERT(search.report().upper_bound == static_cast<float>(best) * unit(kPoints));
  if (!search.report().found) { return; }
  const PoseExclusion excluded{search.report().best.pose, 0.4F, 1.5F * kDegree};
  search.begin_elsewhere(excluded, 0.0F);
  while (!search.step(1000)) {}
  const std::int32_t rival = brute_force(ground, {}, window, config, kPoints, area, excluded);
  RC_ASSERT(search.report().exact);
  RC_ASSERT(search.report().found == (rival > 0));
  RC_ASSERT(search.report().upper_bound == static_cast<float>(rival) * unit(kPoints));
}

TEST(PoseSearch, GivenAKidnappedVehicleThenTheWholeMapAndCircleAreSearchedExactly) {
  const Ground ground;
  PoseSearch search;
  const SearchWindow everything{
      .centre = {6.4F, 6.4F, 0.0F}, .half_translation_m = 6.4F, .half_rotation_rad = 3.14159265F};
  ASSERT_EQ(search.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(),
                          everything),
            Status::ok);
  const PoseSearchReport report = search.report();
  ASSERT_TRUE(report.exact);
  ASSERT_TRUE(report.found);
  EXPECT_NEAR(report.best.pose.x_m, ground.true_pose.x_m, 0.08F);
  EXPECT_NEAR(report.best.pose.y_m, ground.true_pose.y_m, 0.08F);
  EXPECT_NEAR(wrap_angle(report.best.pose.theta_rad - ground.true_pose.theta_rad), 0.0F,
              1.5F * kDegree);
  EXPECT_GT(report.best.score, 0.8F);
  // Far fewer nodes than poses: 257 * 257 * 361.
  EXPECT_LT(report.nodes, 257U * 257U * 361U / 10U);
}

TEST(PoseSearch, GivenSlicesThenTheReportImprovesAndEndsWithTheSameBits) {
  const Ground ground;
  const SearchWindow window{.centre = {ground.true_pose.x_m + 0.4F, ground.true_pose.y_m - 0.3F,
                                       ground.true_pose.theta_rad + 0.3F}};
  PoseSearch whole;
  ASSERT_EQ(
      whole.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(), window),
      Status::ok);
  PoseSearch sliced;
  ASSERT_EQ(
      sliced.begin(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(), window),
      Status::ok);
  PoseSearchReport before = sliced.report();
  EXPECT_FLOAT_EQ(before.upper_bound, 1.0F);
  while (!sliced.step(50)) {
    const PoseSearchReport now = sliced.report();
    EXPECT_GE(now.nodes, before.nodes);
    EXPECT_LE(now.nodes, before.nodes + 50 + PoseSearch::kMaxRowSquares);
    EXPECT_LE(now.upper_bound, before.upper_bound);
    EXPECT_GE(now.best.score, before.best.score);
    EXPECT_GE(now.upper_bound, whole.report().best.score);
    EXPECT_FALSE(now.exact);
    before = now;
  }
  EXPECT_EQ(sliced.report().best.pose, whole.report().best.pose);
  EXPECT_EQ(sliced.report().best.score, whole.report().best.score);
  EXPECT_EQ(sliced.report().nodes, whole.report().nodes);
  EXPECT_EQ(sliced.report().upper_bound, sliced.report().best.score);
}

TEST(PoseSearch, GivenANodeBudgetThenItEndsWithTheBestSoFarAndAnHonestBound) {
  const Ground ground;
  const SearchWindow everything{
      .centre = {6.4F, 6.4F, 0.0F}, .half_translation_m = 5.0F, .half_rotation_rad = 3.14159265F};
  PoseSearch whole;
  ASSERT_EQ(whole.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(),
                         everything),
            Status::ok);
  for (const std::uint32_t budget : {1000U, whole.report().nodes / 2, whole.report().nodes - 50}) {
    PoseSearch limited{{.max_nodes = budget}};
    ASSERT_EQ(limited.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(),
                             everything),
              Status::ok);
    const PoseSearchReport report = limited.report();
    EXPECT_FALSE(report.exact);
    EXPECT_GE(report.nodes, budget);
    EXPECT_LE(report.nodes, budget + PoseSearch::kMaxRowSquares);
    EXPECT_GE(report.upper_bound, whole.report().best.score);
    EXPECT_LE(report.best.score, whole.report().best.score);
  }
}

TEST(PoseSearch, GivenBestFirstThenFewerNodesThanByIndex) {
  const Ground ground;
  const SearchWindow window{.centre = {ground.true_pose.x_m - 0.4F, ground.true_pose.y_m + 0.4F,
                                       ground.true_pose.theta_rad - 0.4F},
                            .half_translation_m = 1.5F,
                            .half_rotation_rad = 1.0F};
  std::array<std::uint32_t, 2> nodes{};
  std::array<float, 2> scores{};
  for (const ChildOrder order : {ChildOrder::index, ChildOrder::best_first}) {
    PoseSearch search{{.order = order}};
    ASSERT_EQ(search.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(),
                            window),
              Status::ok);
    nodes[static_cast<std::size_t>(order)] = search.report().nodes;
    scores[static_cast<std::size_t>(order)] = search.report().best.score;
  }
  EXPECT_EQ(scores[0], scores[1]);
  EXPECT_LT(nodes[1], nodes[0]);
}

TEST(PoseSearch, GivenAMinimumScoreThatNothingReachesThenNothingIsFoundCheaply) {
  const Ground ground;
  const SearchWindow window{.centre = ground.true_pose};
  PoseSearch search{{.min_score = 0.999F}};
  ASSERT_EQ(
      search.search(ground.map->core().field(), ground.pyramid.view(), ground.scan.view(), window),
      Status::ok);
  EXPECT_TRUE(search.report().exact);
  EXPECT_FALSE(search.report().found);
}

TEST(PoseSearch, GivenBadRequestsThenTheyAreRefused) {
  const Ground ground;
  const DistanceFieldView field = ground.map->core().field();
  const MaxPyramid<128, 128, 2> other;
  PoseSearch search;
  EXPECT_EQ(search.begin(field, ground.pyramid.view(), {}, {}), Status::degenerate);
  EXPECT_EQ(search.begin(field, other.view(), ground.scan.view(), {}), Status::invalid_argument);
  EXPECT_EQ(search.begin(field, {}, ground.scan.view(), {}), Status::invalid_argument);
  EXPECT_EQ(
      search.begin(field, ground.pyramid.view(), ground.scan.view(), {.half_translation_m = 60.0F}),
      Status::full);
  EXPECT_EQ(
      search.begin(field, ground.pyramid.view(), ground.scan.view(), {.half_rotation_rad = 10.0F}),
      Status::full);
  EXPECT_EQ(search.begin(field, ground.pyramid.view(), ground.scan.view(),
                         {.half_rotation_rad = std::nanf("")}),
            Status::invalid_argument);
  EXPECT_TRUE(search.step(1));
  EXPECT_FALSE(search.report().found);
}

}  // namespace
}  // namespace picolo
