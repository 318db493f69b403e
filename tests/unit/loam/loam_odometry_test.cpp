// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/loam_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "picolo/core/hash.hpp"
#include "room.hpp"

namespace picolo {
namespace {

using Odometry = LoamOdometry<16, 1024>;

LoamConfig compensated() {
  LoamConfig config;
  config.compensated = true;
  config.features.min_range_m = 0.5F;
  return config;
}

struct Errors {
  double distance_m = 0;
  double angle_rad = 0;
};

Errors errors_of(const LoamReport& report, const Pose3d& first, const Pose3d& truth) {
  const Pose3d wanted = between(first, truth);
  return {norm(difference(report.map_T_lidar.translation_m, wanted.translation_m)),
          rotation_angle_rad(compose(inverse(report.map_T_lidar.rotation), wanted.rotation))};
}

TEST(LoamOdometry, GivenADriveThroughARoomThenThePoseFollowsTheTruth) {
  const test::Room room;
  auto odometry = std::make_unique<Odometry>(compensated());
  for (int i = 0; i < 30; ++i) {
    const Pose3d pose = test::on_curve(i);
    test::run_scan(odometry->core(),
                   test::scan_of(room, pose, pose, 0.01, 50 + static_cast<std::uint64_t>(i)));
    const LoamReport& report = odometry->core().report();
    const Errors errors = errors_of(report, test::on_curve(0), pose);
    EXPECT_LT(errors.distance_m, 0.03) << "scan " << i;
    EXPECT_LT(errors.angle_rad, 0.008) << "scan " << i;
    if (i > 1) {
      EXPECT_EQ(report.map_outcome, SolveOutcome::converged);
      EXPECT_GT(report.matched_surfaces, 300U);
      EXPECT_GT(report.covariance[35], 0.0F);
    }
  }
  EXPECT_EQ(odometry->core().report().scans, 30U);
}

/// How far, in the mean, the last scan's surfaces are off the room's, seen from the true pose.
double blur_m(const test::Room& room, const LoamCore& core, const Pose3d& truth) {
  double total = 0;
  for (const Feature& feature : core.surfaces()) {
    const double range = norm(to_f64(feature.point_m));
    const Vector3d ray = scaled(rotate(truth.rotation, to_f64(feature.point_m)), 1 / range);
    total += std::min(1.0, std::abs(room.range_m(truth.translation_m, ray) - range));
  }
  return total / static_cast<double>(core.surfaces().size());
}

TEST(LoamOdometry, GivenMotionDuringTheScanThenUndistortionRemovesIt) {
  const test::Room room;
  double blurred_m[2] = {0, 0};
  for (const bool ignore : {false, true}) {
    LoamConfig config = compensated();
    config.compensated = ignore;
    auto odometry = std::make_unique<Odometry>(config);
    for (int i = 0; i < 20; ++i) {
      const Pose3d end = test::on_curve(i + 1);
      test::run_scan(odometry->core(), test::scan_of(room, test::on_curve(i), end, 0.005,
                                                     80 + static_cast<std::uint64_t>(i)));
      if (i < 4) { continue; }  // the first scan's own motion cannot be known
      blurred_m[ignore ? 1 : 0] += blur_m(room, odometry->core(), end) / 16;
      const Pose3d moved = odometry->core().report().last_T_lidar;
      const Pose3d wanted = between(test::on_curve(i), end);
      EXPECT_LT(norm(difference(moved.translation_m, wanted.translation_m)), 0.04);
    }
  }
  EXPECT_LT(blurred_m[0], 0.025);
  EXPECT_GT(blurred_m[1], 4 * blurred_m[0]);
}

TEST(LoamOdometry, GivenSmallSlicesThenTheResultIsTheSameBits) {
  const test::Room room;
  std::uint64_t hashes[2] = {};
  int most[2] = {};
  for (const bool small : {false, true}) {
    LoamConfig config = compensated();
    config.slice_features = small ? 64 : 100000;
    auto odometry = std::make_unique<Odometry>(config);
    Hash hash;
    for (int i = 0; i < 5; ++i) {
      const Pose3d pose = test::on_curve(i);
      most[small ? 1 : 0] =
          test::run_scan(odometry->core(), test::scan_of(room, pose, pose, 0.01, 9));
      const Pose3d& result = odometry->core().report().map_T_lidar;
      for (const double value :
           {result.translation_m.x, result.translation_m.y, result.rotation.z}) {
        hash.add(value);
      }
    }
    EXPECT_FALSE(hash.poisoned());
    hashes[small ? 1 : 0] = hash.value();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_GT(most[1], most[0]);
}

TEST(LoamOdometry, GivenAShortSequenceThenItsHashIsTheSameOnEveryPlatform) {
  const test::Room room;
  auto odometry = std::make_unique<Odometry>(LoamConfig{});
  Hash hash;
  for (int i = 0; i < 6; ++i) {
    const auto seed = 300 + static_cast<std::uint64_t>(i);
    test::run_scan(odometry->core(),
                   test::scan_of(room, test::on_curve(i), test::on_curve(i + 1), 0.01, seed, 600));
    const LoamReport& report = odometry->core().report();
    const Pose3d& pose = report.map_T_lidar;
    for (const double value :
         {pose.translation_m.x, pose.translation_m.y, pose.translation_m.z, pose.rotation.w,
          pose.rotation.x, pose.rotation.y, pose.rotation.z}) {
      hash.add(value);
    }
    for (const float value : report.covariance) { hash.add(value); }
    hash.add(report.matched_surfaces);
  }
  EXPECT_FALSE(hash.poisoned());
  EXPECT_EQ(hash.value(), 2199373629779511245ULL);
}

TEST(LoamOdometry, GivenAnIncompleteScanThenItIsSurvived) {
  const test::Room room;
  auto odometry = std::make_unique<Odometry>(compensated());
  for (int i = 0; i < 8; ++i) {
    const Pose3d pose = test::on_curve(i);
    auto scan = test::scan_of(room, pose, pose, 0.01, 30 + static_cast<std::uint64_t>(i));
    if (i == 5) {
      scan.resize(11);
      scan[10].resize(300);
    }
    test::run_scan(odometry->core(), scan);
    EXPECT_LT(errors_of(odometry->core().report(), test::on_curve(0), pose).distance_m, 0.06);
  }
}

TEST(LoamOdometry, GivenAnEmptyScanThenTheVelocityCarriesOn) {
  const test::Room room;
  auto odometry = std::make_unique<Odometry>(compensated());
  for (int i = 0; i < 4; ++i) {
    const Pose3d pose = test::on_curve(i);
    test::run_scan(odometry->core(), test::scan_of(room, pose, pose, 0.01, 30));
  }
  const Pose3d motion = odometry->core().report().last_T_lidar;
  test::run_scan(odometry->core(), {});
  const LoamReport& report = odometry->core().report();
  EXPECT_EQ(report.map_outcome, SolveOutcome::too_few_residuals);
  EXPECT_NEAR(report.last_T_lidar.translation_m.x, motion.translation_m.x, 1e-5);
}

TEST(LoamOdometry, GivenAThousandPredictionsThenTheRotationStaysUnit) {
  const test::Room room;
  auto odometry = std::make_unique<Odometry>(compensated());
  for (int i = 0; i < 3; ++i) {
    const Pose3d pose = test::on_curve(i);
    test::run_scan(odometry->core(), test::scan_of(room, pose, pose, 0.01, 30));
  }
  for (int i = 0; i < 1000; ++i) { test::run_scan(odometry->core(), {}); }
  const Quaterniond q = odometry->core().report().map_T_lidar.rotation;
  EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-12);
  EXPECT_TRUE(std::isfinite(odometry->core().report().map_T_lidar.translation_m.x));
}

TEST(LoamOdometry, GivenWrongCallsThenTheyAreRefusedAndCounted) {
  auto odometry = std::make_unique<Odometry>(compensated());
  LoamCore& core = odometry->core();
  EXPECT_EQ(core.add_ring(0, {}), Status::not_ready);
  EXPECT_TRUE(core.step());
  core.begin_scan();
  EXPECT_EQ(core.add_ring(16, {}), Status::out_of_range);
  const std::vector<RingPoint> long_ring(1025);
  EXPECT_EQ(core.add_ring(0, long_ring), Status::full);
  EXPECT_EQ(core.report().skipped_rings, 2U);
}

TEST(LoamOdometry, GivenAResetThenItBeginsAnew) {
  const test::Room room;
  auto odometry = std::make_unique<Odometry>(compensated());
  for (int i = 0; i < 3; ++i) {
    const Pose3d pose = test::on_curve(i);
    test::run_scan(odometry->core(), test::scan_of(room, pose, pose, 0.01, 30));
  }
  odometry->core().reset();
  EXPECT_EQ(odometry->surface_map().voxels(), 0U);
  const Pose3d pose = test::on_curve(7);
  test::run_scan(odometry->core(), test::scan_of(room, pose, pose, 0.01, 30));
  EXPECT_EQ(odometry->core().report().map_T_lidar.translation_m, Vector3d{});
  EXPECT_EQ(odometry->core().report().scans, 1U);
}

TEST(LoamOdometry, FitsItsMemoryBudgetFor16Rings) {
  EXPECT_LE(LoamOdometry<>::memory_bytes(), 800U * 1024);
  EXPECT_LE(LoamOdometry<>::memory_bytes() - LoamOdometry<>::map_bytes(), 300U * 1024);
  static_assert(LoamConfig{}.valid());
}

}  // namespace
}  // namespace picolo
