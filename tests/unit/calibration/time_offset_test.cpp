// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/time_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "picolo/core/random.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo {
namespace {

using Estimator = TimeOffset<101, 512>;

double left_at(double t) {
  return 40.0 * t / 10.0 + 3.0 * std::sin(0.7 * t) + 0.8 * std::sin(2.3 * t + 1.0);
}
double right_at(double t) {
  return 40.0 * t / 10.0 - 3.0 * std::sin(0.7 * t) + 0.5 * std::sin(1.9 * t);
}
double heading_at(double t) {
  return 0.18 * right_at(t) - 0.19 * left_at(t);
}

TimeOffsetReport simulated(double offset_s, double noise_rad, std::uint64_t seed,
                           double seconds = 60.0) {
  Estimator estimator;
  Random random{seed};
  double last = 0.0;
  for (int k = 0; k < static_cast<int>(seconds * 100); ++k) {
    const double t = 0.01 * k;
    EXPECT_EQ(estimator.core().add_wheels({t, left_at(t), right_at(t)}), Status::ok);
    if (k % 10 == 0 && k > 0) {  // the second sensor stamps t what it saw at t - offset
      const double theta = heading_at(t - offset_s) - heading_at(last - offset_s);
      EXPECT_EQ(estimator.core().add_rotation(last, t, theta + noise_rad * random.gaussian()),
                Status::ok);
      last = t;
    }
  }
  TimeOffsetReport report;
  EXPECT_EQ(estimator.core().solve(report), Status::ok) << to_string(report.refusal.reason);
  TimeOffsetReport nearby;
  EXPECT_EQ(estimator.core().solve_nearby(nearby), Status::ok);
  TimeOffsetReport sliced;
  estimator.core().begin_solution();
  int slices = 1;
  while (!estimator.core().solve_slice(1, sliced)) { ++slices; }
  EXPECT_GE(slices, 4) << "the lag, one on either side, the report";
  for (const TimeOffsetReport& other : {nearby, sliced}) {
    EXPECT_EQ(other.offset_s.value, report.offset_s.value);
    EXPECT_EQ(other.offset_s.std, report.offset_s.std);
    EXPECT_EQ(other.j21, report.j21);
  }
  return report;
}

TEST(TimeOffset, FindsTheOffsetToAMillisecond) {
  for (const double offset : {0.0, 0.15, -0.15, 0.0437, -0.3719}) {
    const TimeOffsetReport report = simulated(offset, 0.0005, 3);
    EXPECT_NEAR(report.offset_s.value, offset, 0.001);
    EXPECT_NEAR(report.j21, -0.19, 0.002);
    EXPECT_NEAR(report.j22, 0.18, 0.002);
  }
}

TEST(TimeOffset, ItsIntervalsCoverTheTruth) {
  int covered = 0;
  constexpr int kRuns = 200;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const double offset = 0.001 * static_cast<double>(seed % 50) + 0.01;
    const TimeOffsetReport report = simulated(offset, 0.003, seed, 20.0);
    if (std::abs(report.offset_s.value - offset) < 1.96 * report.offset_s.std) { ++covered; }
  }
  EXPECT_GE(covered, kRuns * 90 / 100);
  EXPECT_LE(covered, kRuns * 99 / 100);
}

TEST(TimeOffset, ConstantVelocityIsRefused) {
  for (const double rate : {0.0, 0.5}) {
    Estimator estimator;
    Random random{5};
    for (int k = 0; k < 3000; ++k) {
      const double t = 0.01 * k;
      ASSERT_EQ(estimator.core().add_wheels({t, 2.0 * t, (2.0 + rate) * t}), Status::ok);
      if (k % 10 == 9) {
        ASSERT_EQ(
            estimator.core().add_rotation(t - 0.1, t, 0.018 * rate + 0.001 * random.gaussian()),
            Status::ok);
      }
    }
    TimeOffsetReport report;
    EXPECT_EQ(estimator.core().solve(report), Status::degenerate);
    EXPECT_EQ(report.refusal, (Refusal{RefusalReason::constant_velocity, Parameter::time_offset}));
  }
}

TEST(TimeOffset, UnrelatedRotationIsRefused) {
  Estimator estimator;
  Random random{6};
  for (int k = 0; k < 3000; ++k) {
    const double t = 0.01 * k;
    ASSERT_EQ(estimator.core().add_wheels({t, left_at(t), right_at(t)}), Status::ok);
    if (k % 10 == 9) {
      ASSERT_EQ(estimator.core().add_rotation(t - 0.1, t, 0.1 * random.gaussian()), Status::ok);
    }
  }
  TimeOffsetReport report;
  EXPECT_EQ(estimator.core().solve(report), Status::degenerate);
}

TEST(TimeOffset, ChecksWhatItIsGiven) {
  TimeOffset<5, 8, 2> estimator;
  TimeOffsetCore& core = estimator.core();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(core.add_wheels({kNan, 0, 0}), Status::invalid_argument);
  EXPECT_EQ(core.add_rotation(1.0, 1.0, 0.0), Status::invalid_argument);
  EXPECT_EQ(core.add_rotation(0.0, 1.0, kNan), Status::invalid_argument);
  EXPECT_EQ(core.add_wheels({0.0, 0, 0}), Status::ok);
  EXPECT_EQ(core.add_wheels({0.0, 0, 0}), Status::out_of_range);
  EXPECT_EQ(core.add_rotation(0.0, 0.1, 0.0), Status::ok);
  EXPECT_EQ(core.add_rotation(0.1, 0.2, 0.0), Status::ok);
  EXPECT_EQ(core.add_rotation(0.2, 0.3, 0.0), Status::full);
  EXPECT_EQ(core.dropped(), 1U);
  for (int k = 1; k < 20; ++k) { EXPECT_EQ(core.add_wheels({0.1 * k, 0, 0}), Status::ok); }
  EXPECT_EQ(core.dropped(), 3U) << "the history never reached back far enough";
  TimeOffsetReport report;
  EXPECT_EQ(core.solve(report), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::too_little_data);
}

TEST(TimeOffset, GyroOfASkidSteerLagsItsWheelsByFortyMilliseconds) {
  PICOLO_NEED_DATA("imu/ese650_enc_imu_20.txt.gz");
  TimeOffset<101, 256, 128> estimator{{.parameter = Parameter::gyro_offset}};
  double left = 0.0;
  double right = 0.0;
  double last_s = -1.0;
  double theta = 0.0;
  int count = 0;
  double begin_s = -1.0;
  for (const std::string& line : test::gz_lines(test::data_path("imu/ese650_enc_imu_20.txt.gz"))) {
    const std::vector<double> v = test::numbers_in(line);
    if (line.starts_with("ENC")) {
      right += v[1] + v[3];
      left += v[2] + v[4];
      static_cast<void>(estimator.core().add_wheels({v[0], 0.0087 * left, 0.0087 * right}));
    } else if (line.starts_with("IMU")) {
      if (begin_s >= 0.0) {
        theta += v[3] * (v[0] - last_s);
      }  // rate over the interval that ends at its stamp
      if (begin_s < 0.0) { begin_s = v[0]; }
      last_s = v[0];
      ++count;
      if (count % 5 == 0) {
        static_cast<void>(estimator.core().add_rotation(begin_s, v[0], theta));
        begin_s = v[0];
        theta = 0.0;
      }
    }
  }
  TimeOffsetReport report;
  ASSERT_EQ(estimator.core().solve(report), Status::ok) << to_string(report.refusal.reason);
  std::printf("gyro lag %.4f +- %.4f s, explained %.3f, %llu intervals\n", report.offset_s.value,
              report.offset_s.std, report.explained,
              static_cast<unsigned long long>(report.intervals));
  EXPECT_NEAR(report.offset_s.value, 0.04, 0.02);
}

TEST(TimeOffset, MemoryIsConstant) {
  std::printf("bytes of state: time offset, 101 lags and 128 wheel samples: %zu\n",
              sizeof(TimeOffset<101, 128>));
  static_assert(sizeof(TimeOffset<101, 128>) < 10 * 1024);
}

}  // namespace
}  // namespace picolo
