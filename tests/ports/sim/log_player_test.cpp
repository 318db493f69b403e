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
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/sensing/sweep.hpp"

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

struct SeenScan {
  std::size_t step;
  std::vector<RangeReturn> returns;
  Pose2d odom_T_base;
};

/// The firmware's side: real drivers, plain odometry.
class Firmware {
 public:
  Firmware(LogPlayer& player, const LogPlayerConfig& config, const Pose2d& start)
      : player_(player),
        script_(config.script),
        wheels_(player.can(), wheels_config()),
        lidar_(player.lidar_port(), {}),
        pose_(start) {}

  void cycle() {
    for (auto frame = player_.can().receive(); frame; frame = player_.can().receive()) {
      wheels_.consume(*frame);
      const auto ticks = wheels_.take();
      if (ticks) { integrate(*ticks); }
    }
    EXPECT_EQ(wheels_.service(player_.now()), Status::ok);
    std::array<RangeReading, 120> readings{};
    for (auto count = lidar_.poll(1024, readings); count; count = lidar_.poll(1024, readings)) {
      for (const RangeReading& reading : std::span{readings}.first(*count)) {
        assembler_.add(reading);
      }
    }
    if (assembler_.ready()) { take_sweep(); }
  }

  [[nodiscard]] const std::vector<SeenScan>& scans() const { return scans_; }
  [[nodiscard]] const CanopenWheels& wheels() const { return wheels_; }
  [[nodiscard]] const Ld06& lidar() const { return lidar_; }

 private:
  static CanopenWheelsConfig wheels_config() {
    CanopenWheelsConfig config = two_cia402_drives(1, 2);
    config.produce_sync = true;
    return config;
  }

  void integrate(const WheelTicks& ticks) {
    if (!ticks.restarted) {
      const double left_m =
          static_cast<double>(ticks.ticks[0] - last_[0]) * script_.metres_per_count;
      const double right_m =
          static_cast<double>(ticks.ticks[1] - last_[1]) * script_.metres_per_count;
      pose_ = pose_ * exp_se2(Tangent2<double>{.x_m = 0.5 * (left_m + right_m),
                                               .theta_rad = (right_m - left_m) / script_.track_m});
    }
    last_ = {ticks.ticks[0], ticks.ticks[1]};
  }

  void take_sweep() {
    const Sweep sweep = assembler_.take();
    EXPECT_EQ(*player_.step_at(sweep.stamp), *player_.step_at(sweep.last_stamp));
    const auto step = player_.step_at(sweep.stamp);
    scans_.push_back({step.value_or(999'999), {sweep.returns.begin(), sweep.returns.end()}, pose_});
  }

  LogPlayer& player_;
  WheelScriptConfig script_;
  CanopenWheels wheels_;
  Ld06 lidar_;
  SweepAssembler<2000> assembler_;
  Pose2d pose_;
  std::array<std::int64_t, 2> last_{};
  std::vector<SeenScan> scans_;
};

TEST(LogPlayer, GivenALogThenEverySweepCarriesItsBeamsAndEveryPoseItsOdometry) {
  const Log log = make_log(40, 21);
  const LogPlayerConfig config;
  const auto player = std::make_unique<LogPlayer>(config, log.steps);
  const auto firmware = std::make_unique<Firmware>(*player, config, log.steps[0].odom_T_base);
  for (Timestamp t{}; !player->finished() && t < Timestamp{200s}; t += 5ms) {
    player->advance_to(t);
    firmware->cycle();
  }
  ASSERT_TRUE(player->finished());
  ASSERT_EQ(firmware->scans().size(), log.steps.size());
  for (std::size_t i = 0; i < log.steps.size(); ++i) {
    const SeenScan& seen = firmware->scans()[i];
    EXPECT_EQ(seen.step, i);
    const Pose2d& odometry = log.steps[i].odom_T_base;
    EXPECT_LT(std::hypot(seen.odom_T_base.x_m - odometry.x_m, seen.odom_T_base.y_m - odometry.y_m),
              0.0003);
    EXPECT_NEAR(wrap_angle(seen.odom_T_base.theta_rad - odometry.theta_rad), 0.0, 0.00011);

    std::vector<RangeReturn> hits;
    for (const RangeReturn& r : seen.returns) {
      if (r.range_m > 0.0F) { hits.push_back(r); }
    }
    std::vector<RecordedBeam> beams;
    for (const RecordedBeam& beam : log.beams[i]) {
      if (beam.range_m < 65.0F) { beams.push_back(beam); }
    }
    ASSERT_EQ(hits.size(), beams.size());
    // A sweep starts ahead and turns clockwise: first the right half, then the left half backwards.
    for (const RangeReturn& hit : hits) {
      const auto same = [&](const RecordedBeam& beam) {
        return std::abs(beam.bearing_rad - hit.bearing_rad) < 2e-6F &&
               std::abs(beam.range_m - hit.range_m) < 0.0006F;
      };
      EXPECT_TRUE(std::any_of(beams.begin(), beams.end(), same)) << i << ' ' << hit.bearing_rad;
    }
  }
  EXPECT_EQ(firmware->lidar().counters().bad_checksums, 0U);
  EXPECT_EQ(firmware->lidar().counters().implausible, 0U);
  EXPECT_EQ(firmware->lidar().counters().clock_restarts, 0U);
  EXPECT_EQ(firmware->wheels().counters().unpaired, 0U);
  EXPECT_EQ(player->lidar_port().lost(), 0U);
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
