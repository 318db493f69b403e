// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/track_batch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo {
namespace {

struct Recording {
  std::vector<WheelAngles> wheels;
  std::vector<TrackPosition> positions;
};

const DriveParameters kTruth{0.0752, 0.0748, 0.402, {}};
const Pose2d kStart{1.8, -0.4, 2.4};
const Pose2d kMarker{0.05, 0.02, 0.0};

Recording recorded(std::uint64_t seed, double noise_m) {
  Random random{seed};
  Recording r;
  Pose2d pose = kStart;
  double left = 0.0;
  double right = 0.0;
  r.wheels.push_back({0.0, 0.0, 0.0});
  for (int k = 0; k < 300; ++k) {
    const double l = 1.0 + 0.8 * std::sin(0.11 * k);
    const double rr = 1.0 + 0.8 * std::cos(0.07 * k);
    pose = pose * base_motion(kTruth, {1.0, l, rr, {}});
    left += l;
    right += rr;
    r.wheels.push_back({0.2 * (k + 1), left, right});
    const Pose2d seen = pose * kMarker;
    const double x = random.gaussian();
    const double y = random.gaussian();
    r.positions.push_back({0.2 * (k + 1), seen.x_m + noise_m * x, seen.y_m + noise_m * y});
  }
  return r;
}

TEST(TrackBatch, FindsWheelsStartAndMarker) {
  const Recording r = recorded(1, 0.0);
  SpanSource<WheelAngles> wheels{r.wheels};
  SpanSource<TrackPosition> positions{r.positions};
  TrackReport report;
  ASSERT_EQ(calibrate_track(wheels, positions, {.radius_m = 0.07, .track_m = 0.36}, report),
            Status::ok);
  EXPECT_NEAR(report.radius_left_m.value, kTruth.radius_left_m, 1e-9);
  EXPECT_NEAR(report.radius_right_m.value, kTruth.radius_right_m, 1e-9);
  EXPECT_NEAR(report.track_m.value, kTruth.track_m, 1e-9);
  EXPECT_NEAR(wrap_angle(report.start.theta_rad - kStart.theta_rad), 0.0, 1e-9);
  EXPECT_NEAR(report.marker_x_m, kMarker.x_m, 1e-9);
  EXPECT_NEAR(report.marker_y_m, kMarker.y_m, 1e-9);
  EXPECT_GT(report.rms_before_m, 0.2);
  EXPECT_LT(report.rms_after_m, 1e-9);
  EXPECT_LT(track_rms_m(wheels, positions, report), 1e-9);
}

TEST(TrackBatch, ItsIntervalsCoverTheTruth) {
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording r = recorded(seed, 0.005);
    SpanSource<WheelAngles> wheels{r.wheels};
    SpanSource<TrackPosition> positions{r.positions};
    TrackReport report;
    ASSERT_EQ(calibrate_track(wheels, positions, {.radius_m = 0.07, .track_m = 0.36, .headings = 6},
                              report),
              Status::ok);
    covered += std::abs(report.radius_left_m.value - kTruth.radius_left_m) <
               1.96 * report.radius_left_m.std;
    covered += std::abs(report.radius_right_m.value - kTruth.radius_right_m) <
               1.96 * report.radius_right_m.std;
    covered += std::abs(report.track_m.value - kTruth.track_m) < 1.96 * report.track_m.std;
    EXPECT_NEAR(report.rms_after_m, 0.005 * std::sqrt(2.0), 0.001);
  }
  EXPECT_GE(covered, 52) << "of 60";
}

TEST(TrackBatch, RefusesTooLittleAndWhatIsNotValid) {
  Recording r = recorded(1, 0.0);
  r.positions.resize(10);
  SpanSource<WheelAngles> wheels{r.wheels};
  SpanSource<TrackPosition> positions{r.positions};
  TrackReport report;
  EXPECT_EQ(calibrate_track(wheels, positions, {}, report), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::too_little_data);
  EXPECT_EQ(calibrate_track(wheels, positions, {.radius_m = 0.0}, report),
            Status::invalid_argument);
  SpanSource<WheelAngles> none{{}};
  EXPECT_EQ(calibrate_track(none, positions, {}, report), Status::degenerate);
}

}  // namespace
}  // namespace picolo
