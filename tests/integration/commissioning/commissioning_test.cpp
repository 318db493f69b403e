// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A thousand vehicles, each driven as the routine advises: none is refused, and the intervals that
// it states cover the truth as often as they say.

#include "commissioning.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace picolo {
namespace {

constexpr int kDrives = 1000;

test::Truth vehicle(std::uint64_t seed) {
  Random random{seed};
  test::Truth truth;
  DriveParameters& d = truth.drive;
  d.radius_left_m = random.uniform(0.05, 0.12);
  d.radius_right_m = d.radius_left_m * random.uniform(0.98, 1.02);
  d.track_m = random.uniform(0.3, 0.6);
  d.base_T_lidar.x_m = random.uniform(-0.3, 0.3);
  d.base_T_lidar.y_m = random.uniform(-0.1, 0.1);
  d.base_T_lidar.theta_rad = random.uniform(-3.0, 3.0);
  truth.lidar_age_s = random.uniform(0.0, 0.15);
  truth.gyro_age_s = random.uniform(0.0, 0.04);
  truth.gyro_bias_radps = random.uniform(-0.02, 0.02);
  truth.gyro_scale = random.uniform(0.97, 1.03);
  return truth;
}

std::array<double, 6> values(const DriveParameters& d) {
  return {d.radius_left_m,    d.radius_right_m,   d.track_m,
          d.base_T_lidar.x_m, d.base_T_lidar.y_m, d.base_T_lidar.theta_rad};
}

TEST(Commissioning, AThousandSufficientDrivesAreAcceptedAndHonest) {
  int refused = 0;
  std::array<int, 6> covered{};
  std::array<int, 6> accurate{};
  int clocks = 0;
  double longest_s = 0.0;
  double total_s = 0.0;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const test::Truth truth = vehicle(seed);
    test::Commissioning drive{truth, seed};
    drive.follow_advice(2000.0);
    const CalibrationRoutine& routine = drive.routine();
    if (routine.phase() != CalibrationPhase::done) {
      ++refused;
      std::printf("seed %d: %s: %s: %s\n", static_cast<int>(seed), to_string(routine.phase()),
                  to_string(routine.refusal().parameter), to_string(routine.refusal().reason));
      continue;
    }
    longest_s = std::max(longest_s, drive.now_s());
    total_s += drive.now_s();
    const CalibrationRecord& record = routine.record();
    const auto found = values(record.drive);
    const auto t = values(truth.drive);
    const std::array<double, 6> limits{1e-3 * t[0], 1e-3 * t[1], 1e-3 * t[2],
                                       0.002,       0.002,       0.1 * 3.14159265 / 180.0};
    for (std::size_t k = 0; k < 6; ++k) {
      const double error = std::abs(k == 5 ? wrap_angle(found[k] - t[k]) : found[k] - t[k]);
      covered[k] += error < 1.96 * record.drive_std[k] ? 1 : 0;
      accurate[k] += error < limits[k] ? 1 : 0;
    }
    clocks += std::abs(record.time_offset_s - truth.lidar_age_s) < 0.001 ? 1 : 0;
  }
  std::printf("%d drives, %d refused, mean %.0f s, longest %.0f s\n", kDrives, refused,
              total_s / kDrives, longest_s);
  std::printf("95 %% intervals cover: %d %d %d %d %d %d\n", covered[0], covered[1], covered[2],
              covered[3], covered[4], covered[5]);
  std::printf("within 0.1 %%, 2 mm, 0.1 deg: %d %d %d %d %d %d; clock within 1 ms: %d\n",
              accurate[0], accurate[1], accurate[2], accurate[3], accurate[4], accurate[5], clocks);
  EXPECT_EQ(refused, 0);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_GE(covered[k], kDrives * 93 / 100) << "parameter " << k;
    EXPECT_LE(covered[k], kDrives * 97 / 100) << "parameter " << k;
    EXPECT_GE(accurate[k], kDrives * 90 / 100) << "parameter " << k;
  }
  EXPECT_GE(clocks, kDrives * 90 / 100);
}

}  // namespace
}  // namespace picolo
