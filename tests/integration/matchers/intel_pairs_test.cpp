// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Every matcher on real pairs of scans, from a guess that is 0.2 m and 10 degrees off. The
// reference motions are good to 2-4 cm and 0.3 degrees themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numbers>
#include <string_view>

#include "intel_log.hpp"
#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/map/max_pyramid.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/correlative.hpp"
#include "picolo/matching/icp.hpp"
#include "picolo/matching/levenberg_marquardt.hpp"
#include "picolo/matching/ndt.hpp"
#include "picolo/matching/plicp.hpp"
#include "picolo/matching/pose_search.hpp"
#include "picolo/matching/surface.hpp"

namespace picolo {
namespace {

using Map = RollingMap<1024, 1024>;
using Field = DistanceFieldView;

struct Errors {
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double share_within(const Errors& errors, double limit_m, double limit_rad) {
  std::size_t good = 0;
  for (std::size_t i = 0; i < errors.translation_m.size(); ++i) {
    good += errors.translation_m[i] < limit_m && errors.rotation_rad[i] < limit_rad ? 1U : 0U;
  }
  return static_cast<double>(good) / static_cast<double>(errors.translation_m.size());
}

/// What is built once a pair, out of the reference scan alone.
struct Reference {
  std::unique_ptr<Map> map = std::make_unique<Map>();
  std::unique_ptr<MaxPyramid<1024, 1024, 3>> pyramid =
      std::make_unique<MaxPyramid<1024, 1024, 3>>();
  std::unique_ptr<NdtMap<100, 100>> ndt =
      std::make_unique<NdtMap<100, 100>>(NdtMapConfig{.cell_m = 1.0F, .min_points = 3});
  const test::PlainScan* scan = nullptr;

  void draw(const test::PlainScan& points) {
    scan = &points;
    map->core().reset(0.0, 0.0);
    ndt->core().reset(0.0, 0.0);
    map->core().begin_scan();
    for (std::size_t k = 0; k < points.x_m.size(); ++k) {
      const Point2f p = {points.x_m[k], points.y_m[k]};
      map->core().add_hit(transform(in_map({}), p));
      ndt->core().add(transform(to_window(ndt->core().window(), {}), p));
    }
    pyramid->core().begin(map->core().field());
    static_cast<void>(pyramid->core().step(1 << 20));
  }
  [[nodiscard]] Pose2f in_map(const Pose2d& pose) const {
    return to_window(map->core().window(), pose);
  }
  [[nodiscard]] Pose2d from_map(const Pose2f& pose) const {
    return to_map(map->core().window(), pose);
  }
};

using Method = std::function<Pose2d(const Reference&, const PointsView&, const Pose2d& guess)>;

constexpr GaussNewtonConfig kRefine{.max_iterations = 40, .min_points = 20};

Pose2d gauss_newton(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  GaussNewtonMatcher<Field> matcher{kRefine};
  return reference.from_map(
      matcher.match(reference.map->core().field(), {points, reference.in_map(guess), {}}).pose);
}

Pose2d levenberg_marquardt(const Reference& reference, const PointsView& points,
                           const Pose2d& guess) {
  LevenbergMarquardtMatcher<Field> matcher{{.residual = kRefine}};
  return reference.from_map(
      matcher.match(reference.map->core().field(), {points, reference.in_map(guess), {}}).pose);
}

/// The best candidates of the grid, each refined; lowest robust cost wins.
Pose2d correlative(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  CorrelativeSearch search;
  const Field field = reference.map->core().field();
  EXPECT_EQ(search.search(field, points,
                          {.centre = reference.in_map(guess),
                           .half_translation_m = 0.3F,
                           .half_rotation_rad = 0.26F}),
            Status::ok);
  LevenbergMarquardtMatcher<Field> matcher{{.residual = kRefine}};
  Pose2f best = reference.in_map(guess);
  float lowest = 3e38F;
  for (const PoseCandidate& candidate : search.candidates()) {
    const MatchReport report = matcher.match(field, {points, candidate.pose, {}});
    const bool usable = report.outcome == MatchOutcome::converged ||
                        report.outcome == MatchOutcome::iteration_limit ||
                        report.outcome == MatchOutcome::degenerate;
    if (usable && matcher.cost() < lowest) {
      lowest = matcher.cost();
      best = report.pose;
    }
  }
  return reference.from_map(best);
}

Pose2d branch_and_bound(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  PoseSearch search;
  EXPECT_EQ(search.search(reference.map->core().field(), reference.pyramid->view(), points,
                          {.centre = reference.in_map(guess),
                           .half_translation_m = 0.3F,
                           .half_rotation_rad = 0.26F}),
            Status::ok);
  return levenberg_marquardt(reference, points, reference.from_map(search.report().best.pose));
}

Pose2d ndt(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  NdtMatcher matcher{{.max_iterations = 60, .min_points = 20}};
  const GridWindow& window = reference.ndt->core().window();
  return to_map(
      window,
      matcher.match(reference.ndt->core().view(), {points, to_window(window, guess), {}}).pose);
}

Pose2d icp(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  IcpMatcher<400> matcher{{.max_iterations = 80}};
  return to_f64(matcher.match(reference.scan->view(), {points, to_f32(guess), {}}).pose);
}

Pose2d point_to_line(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  PlIcpMatcher<400> matcher;
  return to_f64(matcher.match(reference.scan->view(), {points, to_f32(guess), {}}).pose);
}

/// The estimator with its defaults: the first scan founds the map, the second comes without
/// odometry, and the pose was said to be the guess.
Pose2d localiser(const Reference& reference, const PointsView& points, const Pose2d& guess) {
  const auto owner = std::make_unique<Localiser<HallProfile>>();
  UndistortedSweep sweep;
  sweep.points = reference.scan->view();
  EXPECT_EQ(owner->core().process(sweep, false), Status::ok);
  owner->core().set_pose(guess, {});
  sweep.points = {points.x_m, points.y_m};
  EXPECT_EQ(owner->core().process(sweep, false), Status::ok);
  return owner->core().map_T_base();
}

TEST(MatchersOnIntelPairs, GivenAGuess20CentimetresAnd10DegreesOffThenTheMotionIsFound) {
  PICOLO_NEED_DATA(test::kIntelLog);
  const std::vector<test::PlainScan> scans = test::intel_scans();
  const std::vector<test::IntelPair> pairs = test::intel_pairs();
  ASSERT_EQ(scans.size(), 2672U);
  ASSERT_GT(pairs.size(), 400U);
  const std::vector<std::pair<const char*, Method>> methods{
      {"gauss_newton", gauss_newton},
      {"levenberg_marquardt", levenberg_marquardt},
      {"correlative + lm", correlative},
      {"branch and bound + lm", branch_and_bound},
      {"ndt", ndt},
      {"icp", icp},
      {"point to line", point_to_line},
      {"the localiser", localiser}};
  std::vector<Errors> errors(methods.size());
  Random random{42};
  Reference reference;
  for (const test::IntelPair& pair : pairs) {
    reference.draw(scans[pair.reference]);
    const double direction = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double turn = random.below(2) == 0 ? 0.1745329 : -0.1745329;
    const Pose2d guess{pair.reference_T_scan.x_m + 0.2 * std::cos(direction),
                       pair.reference_T_scan.y_m + 0.2 * std::sin(direction),
                       pair.reference_T_scan.theta_rad + turn};
    PointsView points = scans[pair.scan].view();
    std::vector<std::int8_t> along_x(points.size());
    std::vector<std::int8_t> along_y(points.size());
    surface_directions(points, {}, along_x, along_y);
    points.along_x = along_x;
    points.along_y = along_y;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Pose2d found = methods[m].second(reference, points, guess);
      const Pose2d error = between(pair.reference_T_scan, found);
      errors[m].translation_m.push_back(std::hypot(error.x_m, error.y_m));
      errors[m].rotation_rad.push_back(std::abs(wrap_angle(error.theta_rad)));
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::printf("%-22s median %.2f cm, %.3f deg; within 10 cm and 2 deg: %.1f %%\n",
                methods[m].first, 1e2 * median(errors[m].translation_m),
                57.29578 * median(errors[m].rotation_rad),
                1e2 * share_within(errors[m], 0.1, 0.0349));
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (std::string_view{methods[m].first} == "icp") { continue; }  // points to points: a reference
    EXPECT_LE(median(errors[m].translation_m), 0.025) << methods[m].first;
    EXPECT_LE(median(errors[m].rotation_rad) * 57.29578, 0.3) << methods[m].first;
    EXPECT_GT(share_within(errors[m], 0.1, 0.0349), 0.8) << methods[m].first;
  }
}

}  // namespace
}  // namespace picolo
