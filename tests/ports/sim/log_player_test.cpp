// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A log through frames and bytes: the drivers see every step and every beam.

#include "picolo/sim/log_player.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/core/hash.hpp"
#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "wire_firmware.hpp"

namespace picolo::sim {
namespace {

struct Log {
  std::vector<std::vector<RecordedBeam>> beams;
  std::vector<LogStep> steps;
};

/// Key scans as in the hard logs: up to a metre and 30 degrees apart, 360 beams over 180 degrees.
Log make_log(std::size_t scans, std::uint64_t seed) {
  Log log;
  Random random{seed};
  Pose2d pose{.x_m = 1.0, .y_m = 2.0, .theta_rad = 0.3};
  for (std::size_t scan = 0; scan < scans; ++scan) {
    std::vector<RecordedBeam> beams;
    for (int k = 0; k < 360; ++k) {
      const double bearing_deg = -90.0 + 0.5 * k;
      const auto range_m = static_cast<float>(random.uniform(0.3, 60.0));
      beams.push_back({random.below(10) == 0 ? 81.83F : range_m,
                       static_cast<float>(bearing_deg * std::numbers::pi / 180.0)});
    }
    log.beams.push_back(std::move(beams));
    log.steps.push_back({.odom_T_base = pose});
    const double x_m = random.uniform(-0.3, 1.0);
    const double y_m = random.uniform(-0.2, 0.2);
    const double theta_rad = random.uniform(-0.5, 0.5);
    pose = pose * Pose2d{.x_m = x_m, .y_m = y_m, .theta_rad = theta_rad};
  }
  for (std::size_t scan = 0; scan < scans; ++scan) { log.steps[scan].beams = log.beams[scan]; }
  return log;
}

TEST(LogPlayer, GivenALogThenEverySweepCarriesItsBeamsAndEveryPoseItsOdometry) {
  const Log log = make_log(40, 21);
  expect_played(play({}, log.steps), log.steps);
}

TEST(LogPlayer, GivenFastWheelsAndShortDwellsThenStillNothingIsLost) {
  const Log log = make_log(30, 22);
  LogPlayerConfig config;
  config.script = {.max_speed_mps = 20.0, .max_omega_radps = 20.0, .dwell = 11ms};
  config.think_time = 60ms;
  expect_played(play(config, log.steps), log.steps);
}

TEST(LogPlayer, GivenCoarseCountsThenTheErrorStaysWithinOneCount) {
  const Log log = make_log(60, 23);
  LogPlayerConfig config;
  config.script.metres_per_count = 0.00025;
  const PlayedLog played = play(config, log.steps);
  ASSERT_EQ(played.firmware->scans().size(), log.steps.size());
  for (std::size_t i = 0; i < log.steps.size(); ++i) {
    const Pose2d& seen = played.firmware->scans()[i].odom_T_base;
    const Pose2d& odometry = log.steps[i].odom_T_base;
    // Half a count of 1 mrad in heading, over at most 1.1 m, and half a count along.
    EXPECT_LT(std::hypot(seen.x_m - odometry.x_m, seen.y_m - odometry.y_m), 0.001);
    EXPECT_LT(std::abs(wrap_angle(seen.theta_rad - odometry.theta_rad)), 0.00051);
  }
}

TEST(LogPlayer, GivenNoStepsThenItHasFinishedAtOnce) {
  const auto player = std::make_unique<LogPlayer>(LogPlayerConfig{}, std::span<const LogStep>{});
  EXPECT_TRUE(player->finished());
  player->advance_to(Timestamp{1s});
  EXPECT_EQ(player->steps_played(), 0U);
}

TEST(LogPlayer, GivenAnInstantBetweenScansThenNoStep) {
  const Log log = make_log(2, 4);
  const auto player = std::make_unique<LogPlayer>(LogPlayerConfig{}, log.steps);
  player->advance_to(Timestamp{20s});
  ASSERT_TRUE(player->finished());
  EXPECT_EQ(player->step_at(Timestamp{100ms}).status(), Status::out_of_range);
  EXPECT_EQ(player->steps_played(), 2U);
}

TEST(LogPlayer, GivenAnotherStartThenTheSameBytes) {
  const Log log = make_log(3, 8);
  std::array<std::uint64_t, 2> hashes{};
  const std::array starts{Timestamp{}, Timestamp{Duration{(std::int64_t{1} << 32) - 777'000}}};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto player = std::make_unique<LogPlayer>(LogPlayerConfig{.start = starts[i]}, log.steps);
    Hash hash;
    std::array<std::uint8_t, 256> buffer{};
    for (Timestamp t = starts[i]; !player->finished(); t += 5ms) {
      player->advance_to(t);
      const auto read = player->lidar_port().read(buffer);
      if (!read) { continue; }
      hash.add(static_cast<std::int64_t>((read->last_byte_stamp - starts[i]).count()));
      hash.add_bytes(std::span<const std::uint8_t>{buffer}.first(read->size));
    }
    hashes[i] = hash.value();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace picolo::sim
