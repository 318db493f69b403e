// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What must hold for any seed, any log and however time is cut.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/core/hash.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/sim/beam_packets.hpp"
#include "picolo/sim/simulation.hpp"
#include "picolo/sim/wheel_script.hpp"
#include "support/property.hpp"

namespace picolo::sim {
namespace {

/// What the wires carry over one second, SYNC every 50 ms; `stops` are further instants at which
/// time pauses.
std::uint64_t one_second(std::uint64_t seed, const std::vector<int>& stops_us) {
  SimulationConfig config{.seed = seed};
  config.drive.stand_at_start = Duration{0};
  EXPECT_TRUE(config.faults.push_back(
      {.device = Device::wheel_left, .kind = FaultKind::disconnect, .begin = 400ms, .end = 500ms}));
  EXPECT_TRUE(config.faults.push_back({.device = Device::lidar,
                                       .kind = FaultKind::delay,
                                       .end = 1s,
                                       .probability = 0.1F,
                                       .delay = 7ms}));
  const auto sim = std::make_unique<Simulation>(config);
  std::vector<int> instants_us = stops_us;
  for (int t_us = 0; t_us <= 1'000'000; t_us += 50'000) { instants_us.push_back(t_us); }
  std::sort(instants_us.begin(), instants_us.end());
  instants_us.erase(std::unique(instants_us.begin(), instants_us.end()), instants_us.end());
  for (const int t_us : instants_us) {
    sim->advance_to(Timestamp{Duration{t_us}});
    if (t_us % 50'000 != 0) { continue; }
    EXPECT_EQ(sim->can().transmit({.id = 0, .length = 2, .data = {1, 0}}), Status::ok);
    EXPECT_EQ(sim->can().transmit({.id = 0x080}), Status::ok);
  }
  Hash hash;
  std::array<std::uint8_t, 64> buffer{};
  for (SimSerialPort* port : {&sim->lidar_port(), &sim->imu_port()}) {
    for (auto read = port->read(buffer); read; read = port->read(buffer)) {
      hash.add(static_cast<std::int64_t>(read->last_byte_stamp.time_since_epoch().count()));
      hash.add_bytes(std::span<const std::uint8_t>{buffer}.first(read->size));
    }
  }
  for (auto frame = sim->can().receive(); frame; frame = sim->can().receive()) {
    hash.add(static_cast<std::int64_t>(frame->stamp.time_since_epoch().count()));
    hash.add_bytes(frame->data);
  }
  hash.add(sim->truth().world_T_base.x_m);
  return hash.value();
}

TEST(SimulationProperties, HoweverTimeIsCutTheWiresCarryTheSame) {
  EXPECT_TRUE(rc::check([] {
    const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
    const auto stops = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 1'000'000));
    RC_ASSERT(one_second(seed, stops) == one_second(seed, {}));
  }));
}

TEST(WheelScriptProperties, AnyGoalIsReachedWithinOneCountByEqualCounts) {
  EXPECT_TRUE(rc::check([] {
    const auto unit = [] { return *rc::gen::inRange(-1'000'000, 1'000'000) * 1e-6; };
    const WheelScriptConfig config;
    const Pose2d start{.x_m = 10 * unit(), .y_m = 10 * unit(), .theta_rad = 3 * unit()};
    const Pose2d goal{
        .x_m = start.x_m + unit(), .y_m = start.y_m + unit(), .theta_rad = 3 * unit()};
    WheelScript script{config, start};
    const Timestamp end = script.go(goal, Timestamp{});
    const Pose2d& reached = script.odom_T_base();
    RC_ASSERT(std::hypot(reached.x_m - goal.x_m, reached.y_m - goal.y_m) < 0.0003);
    RC_ASSERT(std::abs(wrap_angle(reached.theta_rad - goal.theta_rad)) < 0.00011);
    auto last = script.counts_at(Timestamp{});
    for (Timestamp t{1ms}; t <= end; t += 1ms) {
      const auto now = script.counts_at(t);
      const std::int64_t left = now[0] - last[0];
      const std::int64_t right = now[1] - last[1];
      RC_ASSERT(left == right || left == -right);
      last = now;
    }
  }));
}

TEST(BeamPacketsProperties, AnyBeamsAreHitOnceAndTheRevolutionComesRound) {
  EXPECT_TRUE(rc::check([] {
    const auto bearings_mrad = *rc::gen::unique<std::vector<int>>(rc::gen::inRange(-3141, 3141));
    std::vector<RecordedBeam> beams;
    for (std::size_t i = 0; i < bearings_mrad.size(); ++i) {
      beams.push_back(
          {0.5F + static_cast<float>(i) / 1000.0F, static_cast<float>(bearings_mrad[i]) / 1000.0F});
    }
    const auto packets = std::make_unique<BeamPackets>();
    RC_ASSERT(packets->load(beams) == 0U);
    std::vector<int> seen(beams.size(), 0);
    Ld06Packet packet;
    int count = 0;
    while (packets->next(packet)) {
      RC_ASSERT(++count < 10'000);
      const int span_cdeg = (packet.end_cdeg - packet.start_cdeg + 36'000) % 36'000;
      RC_ASSERT(span_cdeg <= 1200);
      for (std::size_t point = 0; point < kLd06Points; ++point) {
        if (packet.range_mm[point] == 0) { continue; }
        const auto index = static_cast<std::size_t>(packet.range_mm[point] - 500);
        RC_ASSERT(index < beams.size());
        const double cdeg = packet.start_cdeg + span_cdeg * static_cast<double>(point) / 11.0;
        const double bearing_rad = -cdeg * std::numbers::pi / 18'000.0;
        const double error_rad =
            wrap_angle(bearing_rad - static_cast<double>(beams[index].bearing_rad));
        RC_ASSERT(std::abs(error_rad) < 0.02 * std::numbers::pi / 180.0 + 1e-6);
        ++seen[index];
      }
    }
    RC_ASSERT(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  }));
}

}  // namespace
}  // namespace picolo::sim
