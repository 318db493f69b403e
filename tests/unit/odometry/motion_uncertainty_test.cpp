// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/motion_uncertainty.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

constexpr int kSteps = 50;
constexpr float kStep_s = 0.1F;
const Pose2d kMotion{0.06, 0.0, 0.02};
const Pose2d kStartPose{1.0, -2.0, 0.7};

/// Of drives whose steps err as the configuration says.
Matrix3d sampled(const OdometryNoise& noise) {
  Random random{3};
  const auto times = [&random](float sigma) {
    return static_cast<double>(sigma) * random.gaussian();
  };
  Pose2d exact = kStartPose;
  for (int i = 0; i < kSteps; ++i) { exact = exact * kMotion; }
  const double root = std::sqrt(kMotion.x_m);
  Matrix3d covariance{};
  constexpr int kDrives = 4000;
  for (int drive = 0; drive < kDrives; ++drive) {
    const double scale = times(noise.scale);
    const double drift = random.gaussian();
    const double heading_scale = times(noise.heading_scale);
    Pose2d pose = kStartPose;
    for (int i = 0; i < kSteps; ++i) {
      const double turn = kMotion.theta_rad * (1.0 + heading_scale) +
                          root * times(noise.heading_walk_rad) +
                          drift * (static_cast<double>(noise.heading_per_m_rad) * kMotion.x_m +
                                   static_cast<double>(noise.heading_per_s_rad * kStep_s));
      const double x_m = kMotion.x_m * (1.0 + scale) + root * times(noise.walk_m);
      const double y_m = std::sqrt(kMotion.theta_rad) * times(noise.sideways_m);
      pose = pose * Pose2d{x_m, y_m + x_m * 0.5 * (turn - kMotion.theta_rad), turn};
    }
    const std::array<double, 3> error{pose.x_m - exact.x_m, pose.y_m - exact.y_m,
                                      wrap_angle(pose.theta_rad - exact.theta_rad)};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) { covariance(r, c) += error[r] * error[c] / kDrives; }
    }
  }
  return covariance;
}

TEST(MotionUncertainty, IsThatOfSampledDrives) {
  const OdometryNoise noise{.walk_m = 0.02F,
                            .heading_walk_rad = 0.01F,
                            .walk_persists_m = 0.0F,
                            .sideways_m = 0.01F,
                            .scale = 0.01F,
                            .heading_per_m_rad = 0.003F,
                            .heading_per_s_rad = 0.002F,
                            .heading_scale = 0.01F};
  MotionUncertainty made;
  Pose2d pose = kStartPose;
  for (int i = 0; i < kSteps; ++i) {
    made.add(noise, {static_cast<float>(pose.theta_rad), to_f32(kMotion), kStep_s});
    pose = pose * kMotion;
  }
  const Matrix3f covariance = made.covariance();
  const Matrix3d truth = sampled(noise);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(static_cast<double>(covariance(r, c)), truth(r, c),
                  0.08 * std::sqrt(truth(r, r) * truth(c, c)))
          << r << ' ' << c;
    }
  }
}

TEST(MotionUncertainty, AMeasurementLeavesWhatItDoesNotSee) {
  MotionUncertainty made;
  made.start(Matrix3f::diagonal(0.04F, 0.01F, 1e-4F));
  made.correct(Matrix3f::diagonal(1.0F, 0.0F, 0.0F), Matrix3f::diagonal(0.0F, 1e-6F, 1e-8F));
  EXPECT_EQ(made.covariance(), Matrix3f::diagonal(0.04F, 1e-6F, 1e-8F));
}

TEST(MotionUncertainty, AStepMayEnterInPart) {
  MotionUncertainty made;
  made.add({.walk_persists_m = 0.0F}, {0.0F, {1.0F, 0.0F, 0.0F}, 1.0F},
           Matrix3f::diagonal(1.0F, 0.0F, 0.0F));
  const Matrix3f covariance = made.covariance();
  EXPECT_NEAR(covariance(0, 0), 0.01 * 0.01 + 0.005 * 0.005, 1e-8);
  EXPECT_EQ(covariance(1, 1), 0.0F);
  EXPECT_EQ(covariance(2, 2), 0.0F);
}

TEST(MotionUncertainty, ASlipThatLastsErrsAsAWholeOverShortWaysAndWandersOverLongOnes) {
  const OdometryNoise noise{.walk_m = 0.01F, .walk_persists_m = 0.5F, .scale = 0.0F};
  const auto along_m2 = [&noise](int steps) {
    MotionUncertainty made;
    for (int i = 0; i < steps; ++i) { made.add(noise, {0.0F, {0.01F, 0.0F, 0.0F}, 0.01F}); }
    return static_cast<double>(made.covariance()(0, 0));
  };
  EXPECT_NEAR(along_m2(2) / along_m2(1), 4.0, 0.2);
  EXPECT_NEAR(along_m2(50), 1e-4 * 0.25, 1e-7) << "half of white noise where it is as long";
  EXPECT_NEAR(along_m2(4000) / along_m2(2000), 2.0, 0.03);
}

TEST(OdometryNoise, RefusesNegativeSigmas) {
  EXPECT_TRUE(OdometryNoise{}.valid());
  EXPECT_FALSE((OdometryNoise{.walk_m = -0.1F}.valid()));
}

}  // namespace
}  // namespace picolo
