// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Any step of SE(2) by whole counts, without accumulating error, whenever the counters are sampled.

#include "picolo/sim/wheel_script.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::sim {
namespace {

/// What an odometry computes from samples of the counters.
class Odometry {
 public:
  Odometry(const WheelScriptConfig& config, const Pose2d& start) : config_(config), pose_(start) {}

  void sample(const std::array<std::int64_t, 2>& counts) {
    const double left_m = static_cast<double>(counts[0] - last_[0]) * config_.metres_per_count;
    const double right_m = static_cast<double>(counts[1] - last_[1]) * config_.metres_per_count;
    pose_ = pose_ * exp_se2(Tangent2<double>{.x_m = 0.5 * (left_m + right_m),
                                             .theta_rad = (right_m - left_m) / config_.track_m});
    last_ = counts;
  }
  [[nodiscard]] const Pose2d& pose() const { return pose_; }

 private:
  WheelScriptConfig config_;
  Pose2d pose_;
  std::array<std::int64_t, 2> last_{};
};

double position_error(const Pose2d& a, const Pose2d& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

Pose2d random_step(Random& random) {
  const double x_m = random.uniform(-1.0, 1.0);
  const double y_m = random.uniform(-1.0, 1.0);
  const double theta_rad = random.uniform(-0.6, 0.6);
  return {.x_m = x_m, .y_m = y_m, .theta_rad = theta_rad};
}

TEST(WheelScript, GivenHundredsOfStepsThenTheErrorNeverGrowsBeyondOneCount) {
  const WheelScriptConfig config;
  const Pose2d start{.x_m = 3.0, .y_m = -2.0, .theta_rad = 0.7};
  WheelScript script{config, start};
  Odometry odometry{config, start};
  Random random{9};
  Pose2d goal = start;
  Timestamp now{};
  for (int step = 0; step < 500; ++step) {
    goal = goal * random_step(random);
    const Timestamp end = script.go(goal, now);
    for (; now < end; now += 10ms) { odometry.sample(script.counts_at(now)); }
    now = end;
    odometry.sample(script.counts_at(now));
    // One count of heading is 0.2 mrad: half of it over a metre, and half a count along.
    ASSERT_LT(position_error(odometry.pose(), goal), 0.0003) << step;
    ASSERT_LT(std::abs(wrap_angle(odometry.pose().theta_rad - goal.theta_rad)), 0.00011) << step;
    ASSERT_LT(position_error(odometry.pose(), script.odom_T_base()), 1e-9);
  }
}

TEST(WheelScript, GivenAnyPeriodOfSamplingThenTheSamePose) {
  const WheelScriptConfig config;
  for (const Duration period : {3ms, 7ms, 10ms, 19ms}) {
    WheelScript script{config, {}};
    Odometry odometry{config, {}};
    const Timestamp end = script.go({.x_m = 0.7, .y_m = 0.4, .theta_rad = -0.5}, Timestamp{});
    for (Timestamp t{}; t < end; t += period) { odometry.sample(script.counts_at(t)); }
    odometry.sample(script.counts_at(end));
    EXPECT_LT(position_error(odometry.pose(), script.odom_T_base()), 1e-12) << period.count();
  }
}

TEST(WheelScript, GivenAPlaceBehindThenItDrivesBackwards) {
  WheelScript script{{}, {}};
  const Timestamp end = script.go({.x_m = -0.5}, Timestamp{});
  const auto counts = script.counts_at(end);
  EXPECT_EQ(counts[0], -10'000);
  EXPECT_EQ(counts[1], -10'000);
}

TEST(WheelScript, GivenAPlaceBehindToBeReachedFacingItThenItTurnsAndDrivesForward) {
  WheelScript script{{}, {}};
  const Timestamp end = script.go({.x_m = -0.5, .y_m = 0.3, .theta_rad = 2.6}, Timestamp{});
  const auto counts = script.counts_at(end);
  EXPECT_GT(counts[0] + counts[1], 0) << "driven backwards";
}

TEST(WheelScript, GivenATurnOnTheSpotThenTheWheelsOpposeEachOther) {
  const WheelScriptConfig config;
  WheelScript script{config, {}};
  const Timestamp end = script.go({.theta_rad = 0.5}, Timestamp{});
  for (Timestamp t{}; t <= end; t += 1ms) {
    const auto counts = script.counts_at(t);
    ASSERT_EQ(counts[0], -counts[1]);
  }
  EXPECT_EQ(script.counts_at(end)[1], 2500);  // 0.5 rad * 0.25 m / 0.05 mm
}

TEST(WheelScript, GivenNoMovementThenItStandsAndStillTakesItsDwells) {
  const WheelScriptConfig config;
  WheelScript script{config, {}};
  const Timestamp end = script.go({}, Timestamp{1s});
  EXPECT_GE(end - Timestamp{1s}, 3 * config.dwell);
  EXPECT_EQ(script.counts_at(end), (std::array<std::int64_t, 2>{0, 0}));
}

TEST(WheelScript, GivenLimitsThenNoWheelExceedsThem) {
  const WheelScriptConfig config{.max_speed_mps = 1.0, .max_omega_radps = 2.0};
  WheelScript script{config, {}};
  const Timestamp end = script.go({.x_m = 0.6, .y_m = 0.8, .theta_rad = 1.5}, Timestamp{});
  auto last = script.counts_at(Timestamp{});
  for (Timestamp t{10ms}; t <= end; t += 10ms) {
    const auto counts = script.counts_at(t);
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const double speed_mps = std::abs(static_cast<double>(counts[wheel] - last[wheel])) *
                               config.metres_per_count / 0.01;
      ASSERT_LE(speed_mps, 1.0 + 0.01);
    }
    last = counts;
  }
}

TEST(WheelScript, GivenTheRatesThenTheyIntegrateToTheCounts) {
  WheelScript script{{}, {}};
  const Timestamp end = script.go({.x_m = 0.5, .y_m = 0.3, .theta_rad = 0.9}, Timestamp{});
  double right = 0.0;
  for (Timestamp t{500us}; t < end; t += 1ms) {
    right += static_cast<double>(script.rates_at(t)[1]) * 1e-3;
  }
  EXPECT_NEAR(right, static_cast<double>(script.counts_at(end)[1]), 5.0);
}

}  // namespace
}  // namespace picolo::sim
