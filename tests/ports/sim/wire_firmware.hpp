// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The firmware's side of a played log: the real drivers and a plain odometry.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/sensing/sweep.hpp"
#include "picolo/sim/log_player.hpp"

namespace picolo::sim {

struct SeenScan {
  std::size_t step;
  std::vector<RangeReturn> returns;
  Pose2d odom_T_base;
};

/// The firmware's side: real drivers, plain odometry.
class WireFirmware {
 public:
  WireFirmware(LogPlayer& player, const LogPlayerConfig& config, const Pose2d& start)
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

struct PlayedLog {
  std::unique_ptr<LogPlayer> player;
  std::unique_ptr<WireFirmware> firmware;
  Duration duration{};
};

/// Plays a whole log in minor frames of 5 ms.
inline PlayedLog play(const LogPlayerConfig& config, std::span<const LogStep> steps) {
  PlayedLog log;
  log.player = std::make_unique<LogPlayer>(config, steps);
  log.firmware = std::make_unique<WireFirmware>(*log.player, config, steps[0].odom_T_base);
  Timestamp t = config.start;
  for (; !log.player->finished() && t < config.start + 3h; t += 5ms) {
    log.player->advance_to(t);
    log.firmware->cycle();
  }
  log.duration = t - config.start;
  EXPECT_TRUE(log.player->finished());
  return log;
}

/// Every sweep carries its scan's beams at their own bearings, and the odometry is the log's.
inline void expect_played(const PlayedLog& played, std::span<const LogStep> steps) {
  const auto& scans = played.firmware->scans();
  ASSERT_EQ(scans.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const SeenScan& seen = scans[i];
    ASSERT_EQ(seen.step, i);
    const Pose2d& odometry = steps[i].odom_T_base;
    ASSERT_LT(std::hypot(seen.odom_T_base.x_m - odometry.x_m, seen.odom_T_base.y_m - odometry.y_m),
              0.0003);
    ASSERT_NEAR(wrap_angle(seen.odom_T_base.theta_rad - odometry.theta_rad), 0.0, 0.00011);

    std::vector<RangeReturn> hits;
    for (const RangeReturn& r : seen.returns) {
      if (r.range_m > 0.0F) { hits.push_back(r); }
    }
    std::size_t beams = 0;
    for (const RecordedBeam& beam : steps[i].beams) {
      if (!(beam.range_m > 0.0F) || beam.range_m > 65.535F) { continue; }
      ++beams;
      const auto same = [&](const RangeReturn& hit) {
        const float error_rad = wrap_angle(beam.bearing_rad - hit.bearing_rad);
        return std::abs(error_rad) < 0.00035F && std::abs(beam.range_m - hit.range_m) < 0.0006F;
      };
      ASSERT_TRUE(std::any_of(hits.begin(), hits.end(), same)) << i << ' ' << beam.bearing_rad;
    }
    ASSERT_EQ(hits.size(), beams);
  }
  EXPECT_EQ(played.firmware->lidar().counters().bad_checksums, 0U);
  EXPECT_EQ(played.firmware->lidar().counters().implausible, 0U);
  EXPECT_EQ(played.firmware->lidar().counters().clock_restarts, 0U);
  EXPECT_EQ(played.firmware->wheels().counters().unpaired, 0U);
  EXPECT_EQ(played.player->lidar_port().lost(), 0U);
}

}  // namespace picolo::sim
