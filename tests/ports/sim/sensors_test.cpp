// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the real drivers decode from the simulated wires, against the truth.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/sim/simulation.hpp"

namespace picolo::sim {
namespace {

struct Decoded {
  std::vector<RangeReading> readings;
  std::vector<ImuSample> imu;
  std::vector<WheelTicks> wheels;
  std::vector<Truth> truth_of_readings;
  std::vector<Truth> truth_of_imu;
  std::vector<Truth> truth_of_wheels;
  Ld06Counters lidar_counters;
  WitMotionCounters imu_counters;
  CanopenWheelsCounters wheel_counters;
  std::uint32_t wheel_boots = 0;
};

/// The device's clock and the host's agree within a millisecond: it is left out, to compare times
/// exactly.
Ld06Config plain_lidar(Duration latency) {
  Ld06Config config;
  config.timeline.use_device_clock = false;
  config.timeline.latency = latency;
  return config;
}

Decoded run(const SimulationConfig& config, Duration duration) {
  const auto sim = std::make_unique<Simulation>(config);
  Ld06 lidar{sim->lidar_port(), plain_lidar(config.lidar.latency)};
  WitMotion imu{sim->imu_port(), {}};
  CanopenWheelsConfig wheels_config = two_cia402_drives(1, 2);
  wheels_config.produce_sync = true;
  CanopenWheels wheels{sim->can(), wheels_config};
  Decoded out;
  const auto truth_at = [&](Timestamp stamp) { return sim->truth(stamp).value_or({}); };
  for (Timestamp t = config.start; t <= config.start + duration; t += 5ms) {
    sim->advance_to(t);
    for (auto frame = sim->can().receive(); frame; frame = sim->can().receive()) {
      wheels.consume(*frame);
      const auto ticks = wheels.take();
      if (!ticks) { continue; }
      out.wheels.push_back(*ticks);
      out.truth_of_wheels.push_back(truth_at(ticks->stamp));
    }
    static_cast<void>(wheels.service(t));
    std::array<RangeReading, 120> readings{};
    for (auto n = lidar.poll(2048, readings); n; n = lidar.poll(2048, readings)) {
      for (const RangeReading& reading : std::span{readings}.first(*n)) {
        out.readings.push_back(reading);
        out.truth_of_readings.push_back(truth_at(reading.stamp));
      }
    }
    std::array<ImuSample, 16> samples{};
    for (auto n = imu.poll(2048, samples); n; n = imu.poll(2048, samples)) {
      for (const ImuSample& sample : std::span{samples}.first(*n)) {
        out.imu.push_back(sample);
        out.truth_of_imu.push_back(truth_at(sample.stamp));
      }
    }
  }
  out.lidar_counters = lidar.counters();
  out.imu_counters = imu.counters();
  out.wheel_counters = wheels.counters();
  out.wheel_boots = wheels.node(0).boots;
  return out;
}

SimulationConfig noiseless() {
  SimulationConfig config;
  config.lidar.range_sigma_m = 0.0;
  config.lidar.dropout = 0.0;
  config.vehicle.slip_sigma = 0.0;
  config.imu.rate_sigma_radps = 0.0;
  config.imu.rate_bias_sigma_radps = 0.0;
  config.imu.rate_walk_sigma_radps = 0.0;
  config.imu.acceleration_sigma_mps2 = 0.0;
  config.imu.acceleration_bias_sigma_mps2 = 0.0;
  return config;
}

/// What a beam should have measured from the true pose at its own time.
double expected_range(const SimulationConfig& config, const Truth& truth, float bearing_rad) {
  const Pose2d world_T_lidar = truth.world_T_base * config.lidar.base_T_lidar;
  return config.scene.world.cast({world_T_lidar.x_m, world_T_lidar.y_m},
                                 world_T_lidar.theta_rad + static_cast<double>(bearing_rad),
                                 config.lidar.max_range_m);
}

/// Share of beams that agree with the truth at their own time within `tolerance_m`: grazing beams
/// and edges may not.
double share_of_true_beams(const SimulationConfig& config, const Decoded& out, double tolerance_m) {
  std::size_t agree = 0;
  for (std::size_t i = 0; i < out.readings.size(); ++i) {
    const double range_m =
        expected_range(config, out.truth_of_readings[i], out.readings[i].bearing_rad);
    agree += std::abs(range_m - static_cast<double>(out.readings[i].range_m)) <= tolerance_m;
  }
  return static_cast<double>(agree) / static_cast<double>(out.readings.size());
}

TEST(SimulatedLidar, GivenADriveThenEachBeamSeesTheTruthOfItsOwnTime) {
  const SimulationConfig config = noiseless();
  const Decoded out = run(config, 20s);
  ASSERT_GT(out.readings.size(), 80'000U);
  // 1 mm and 0.01 deg of the wire, at up to 12 m.
  EXPECT_GT(share_of_true_beams(config, out, 0.006), 0.98);
  EXPECT_EQ(out.lidar_counters.bad_checksums, 0U);
  EXPECT_EQ(out.lidar_counters.skipped_bytes, 0U);
}

TEST(SimulatedLidar, GivenAMountingAndALatencyThenTheyAreTrueAndShow) {
  SimulationConfig config = noiseless();
  config.lidar.base_T_lidar = {.x_m = -0.2, .y_m = 0.15, .theta_rad = 2.5};
  config.lidar.latency = 7ms;
  config.lidar.rotation_hz = 9.37;
  const Decoded out = run(config, 20s);
  EXPECT_GT(share_of_true_beams(config, out, 0.006), 0.98);
  SimulationConfig wrong = config;
  wrong.lidar.base_T_lidar.theta_rad = 2.52;
  EXPECT_LT(share_of_true_beams(wrong, out, 0.006), 0.6) << "the test cannot tell";
}

TEST(SimulatedLidar, GivenNoiseThenItHasItsSigmaAndItsShareOfDropouts) {
  SimulationConfig config = noiseless();
  config.drive.stand_at_start = 60s;
  config.lidar.range_sigma_m = 0.02;
  config.lidar.dropout = 0.05;
  const Decoded out = run(config, 20s);
  double squares = 0.0;
  double sum = 0.0;
  std::size_t hits = 0;
  std::size_t empty = 0;
  for (const RangeReading& reading : out.readings) {
    const double true_m = expected_range(config, out.truth_of_readings[0], reading.bearing_rad);
    if (true_m == 0.0) { continue; }
    if (reading.range_m == 0.0F) {
      ++empty;
      continue;
    }
    const double error_m = static_cast<double>(reading.range_m) - true_m;
    if (std::abs(error_m) > 0.2) { continue; }  // an edge, by 0.005 deg
    ++hits;
    sum += error_m;
    squares += error_m * error_m;
  }
  const auto count = static_cast<double>(hits);
  EXPECT_NEAR(sum / count, 0.0, 0.0005);
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.001);
  EXPECT_NEAR(static_cast<double>(empty) / (count + static_cast<double>(empty)), 0.05, 0.005);
}

TEST(SimulatedLidar, GivenOneRevolutionThenItTurnsClockwiseOnceIn100Milliseconds) {
  const Decoded out = run(noiseless(), 3s);
  std::vector<Timestamp> starts;
  double turned_rad = 0.0;
  for (std::size_t i = 1; i < out.readings.size(); ++i) {
    turned_rad += static_cast<double>(
        wrap_angle(out.readings[i].bearing_rad - out.readings[i - 1].bearing_rad));
    if (out.readings[i].starts_sweep) { starts.push_back(out.readings[i].stamp); }
  }
  EXPECT_NEAR(turned_rad / static_cast<double>(out.readings.size() - 1),
              -2 * std::numbers::pi / 450, 1e-5);
  ASSERT_GT(starts.size(), 25U);
  for (std::size_t i = 1; i < starts.size(); ++i) {
    // A read that ends inside of a packet hides the idle time before it: 0.63 ms at most.
    EXPECT_NEAR(static_cast<double>((starts[i] - starts[i - 1]).count()), 100'000.0, 630.0);
  }
}

TEST(SimulatedWheels, GivenADriveThenTheCountsAreTheTrueAnglesQuantised) {
  const SimulationConfig config = noiseless();
  const Decoded out = run(config, 20s);
  ASSERT_GT(out.wheels.size(), 1900U);
  for (std::size_t i = 0; i < out.wheels.size(); ++i) {
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const double turned_rad = out.truth_of_wheels[i].wheel_angle_rad[wheel] -
                                out.truth_of_wheels[0].wheel_angle_rad[wheel];
      const double counts = turned_rad / (2 * std::numbers::pi) * config.counts_per_turn;
      // Half a count each at both ends, and up to 0.2 ms (one count) until the SYNC's last bit.
      ASSERT_NEAR(static_cast<double>(out.wheels[i].ticks[wheel]), counts, 1.0 + 1.1);
    }
  }
  EXPECT_EQ(out.wheel_counters.unpaired, 0U);
  EXPECT_EQ(out.wheel_counters.jumps, 0U);
}

TEST(SimulatedImu, GivenNoNoiseThenRatesAndForcesAreTrueToHalfAStepOfTheWire) {
  SimulationConfig config = noiseless();
  config.vehicle.scrub_s = 0.0;
  config.imu.base_T_imu = {.x_m = 0.2, .y_m = -0.1, .theta_rad = 0.6};
  const Decoded out = run(config, 20s);
  ASSERT_GT(out.imu.size(), 1900U);
  const double rate_step = 2000.0 * std::numbers::pi / 180 / 32768;
  const double force_step = 16 * 9.80665 / 32768;
  double fastest_radps = 0.0;
  for (std::size_t i = 0; i < out.imu.size(); ++i) {
    const Truth& truth = out.truth_of_imu[i];
    const auto omega = static_cast<double>(truth.twist.omega_radps);
    fastest_radps = std::max(fastest_radps, std::abs(omega));
    // The driver's stamp may lie a step of the simulation beside the measurement: alpha * 1 ms.
    ASSERT_NEAR(static_cast<double>(out.imu[i].rate_radps[2]), omega, 0.5 * rate_step + 0.0025);
    EXPECT_NEAR(static_cast<double>(out.imu[i].acceleration_mps2[2]), 9.80665, force_step);
    // Perpendicular to the arm nothing but v * omega and the arm's own part; alpha is not in the
    // truth, so look along it.
    const double along = 0.2 / std::hypot(0.2, 0.1);
    const double across = -0.1 / std::hypot(0.2, 0.1);
    const double c = std::cos(0.6);
    const double s = std::sin(0.6);
    const auto fx = static_cast<double>(out.imu[i].acceleration_mps2[0]);
    const auto fy = static_cast<double>(out.imu[i].acceleration_mps2[1]);
    const double base_x = c * fx - s * fy;
    const double base_y = s * fx + c * fy;
    const double outward = along * base_x + across * base_y;
    const double expected = across * static_cast<double>(truth.twist.x_mps) * omega -
                            omega * omega * std::hypot(0.2, 0.1);
    ASSERT_NEAR(outward, expected, 0.5 * along + 0.02) << "beyond the forward acceleration's limit";
  }
  EXPECT_GT(fastest_radps, 0.5) << "the drive never turned";
  EXPECT_EQ(out.imu_counters.bad_checksums, 0U);
}

TEST(SimulatedImu, GivenBiasAndNoiseThenTheyHaveTheirFigures) {
  SimulationConfig config = noiseless();
  config.drive.stand_at_start = 100s;
  config.imu.rate_sigma_radps = 0.01;
  config.imu.rate_bias_sigma_radps = 0.02;
  config.imu.acceleration_sigma_mps2 = 0.1;
  config.imu.acceleration_bias_sigma_mps2 = 0.2;
  const auto sim = std::make_unique<Simulation>(config);
  const std::array<double, 3> bias = sim->imu().rate_bias_radps();
  EXPECT_NE(bias[2], 0.0);
  const Decoded out = run(config, 60s);
  double sum = 0.0;
  double squares = 0.0;
  for (const ImuSample& sample : out.imu) {
    const double error = static_cast<double>(sample.rate_radps[2]) - bias[2];
    sum += error;
    squares += error * error;
  }
  const auto count = static_cast<double>(out.imu.size());
  EXPECT_NEAR(sum / count, 0.0, 4 * 0.01 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.01, 0.0005);
}

/// Runs with one fault from 5 s to 10 s.
Decoded run_with(Device device, FaultKind kind, float probability = 1.0F) {
  SimulationConfig config = noiseless();
  EXPECT_TRUE(config.faults.push_back({.device = device,
                                       .kind = kind,
                                       .begin = 5s,
                                       .end = 10s,
                                       .probability = probability,
                                       .delay = 20ms}));
  return run(config, 15s);
}

TEST(SimulatedFaults, GivenCorruptedLidarPacketsThenTheChecksumCatchesThem) {
  const Decoded out = run_with(Device::lidar, FaultKind::corrupt, 0.2F);
  // 1875 packets in the window, a fifth of them damaged.
  EXPECT_NEAR(static_cast<double>(out.lidar_counters.packets), 5625 - 375, 80);
  EXPECT_GT(out.lidar_counters.bad_checksums, 250U);
}

TEST(SimulatedFaults, GivenASilentImuThenNoSamplesInTheWindow) {
  const Decoded out = run_with(Device::imu, FaultKind::silence);
  std::size_t inside = 0;
  for (const ImuSample& sample : out.imu) {
    inside += sample.stamp > Timestamp{5s} + 10ms && sample.stamp < Timestamp{10s} - 1ms ? 1U : 0U;
  }
  EXPECT_EQ(inside, 0U);
  EXPECT_NEAR(static_cast<double>(out.imu.size()), 1000.0, 4.0);
}

TEST(SimulatedFaults, GivenAnUnpluggedLidarThenNoReadingsInTheWindowAndNoneDamagedAfterIt) {
  const Decoded out = run_with(Device::lidar, FaultKind::disconnect);
  std::size_t inside = 0;
  std::size_t after = 0;
  for (const RangeReading& reading : out.readings) {
    inside += reading.stamp > Timestamp{5s} && reading.stamp < Timestamp{10s} - 5ms ? 1U : 0U;
    after += reading.stamp >= Timestamp{10s} ? 1U : 0U;
  }
  EXPECT_EQ(inside, 0U);
  EXPECT_NEAR(static_cast<double>(after), 22'500.0, 40.0);
}

TEST(SimulatedFaults, GivenAFrozenLidarThenItsPacketsRepeatAndAreWellFormed) {
  const Decoded out = run_with(Device::lidar, FaultKind::freeze);
  std::vector<float> ranges_m;
  for (const RangeReading& reading : out.readings) {
    if (reading.stamp < Timestamp{5s} + 10ms || reading.stamp >= Timestamp{10s} - 5ms) { continue; }
    ranges_m.push_back(reading.range_m);
  }
  ASSERT_GT(ranges_m.size(), 22'000U);
  for (std::size_t i = 12; i < ranges_m.size(); ++i) { ASSERT_EQ(ranges_m[i], ranges_m[i - 12]); }
  EXPECT_EQ(out.lidar_counters.bad_checksums, 0U);
}

TEST(SimulatedFaults, GivenAFrozenGyroThenItsValuesStandStill) {
  const Decoded out = run_with(Device::imu, FaultKind::freeze);
  std::array<float, 3> first{};
  std::size_t inside = 0;
  for (const ImuSample& sample : out.imu) {
    if (sample.stamp < Timestamp{5s} + 15ms || sample.stamp >= Timestamp{10s} - 1ms) { continue; }
    if (inside == 0) { first = sample.rate_radps; }
    EXPECT_EQ(sample.rate_radps, first);
    ++inside;
  }
  EXPECT_GT(inside, 490U);
}

TEST(SimulatedFaults, GivenAFrozenWheelThenItsCountStandsWhileTheOtherRuns) {
  const Decoded out = run_with(Device::wheel_left, FaultKind::freeze);
  std::int64_t left_moved = 0;
  std::int64_t right_moved = 0;
  const WheelTicks* last = nullptr;
  for (const WheelTicks& ticks : out.wheels) {
    if (ticks.stamp < Timestamp{5s} + 15ms || ticks.stamp >= Timestamp{10s}) { continue; }
    if (last != nullptr) {
      left_moved += std::abs(ticks.ticks[0] - last->ticks[0]);
      right_moved += std::abs(ticks.ticks[1] - last->ticks[1]);
    }
    last = &ticks;
  }
  EXPECT_EQ(left_moved, 0);
  EXPECT_GT(right_moved, 10'000);
}

TEST(SimulatedFaults, GivenAWheelWithoutPowerThenTheDriverSeesANewBootAndARestart) {
  const Decoded out = run_with(Device::wheel_left, FaultKind::disconnect);
  EXPECT_EQ(out.wheel_boots, 2U);
  std::size_t inside = 0;
  std::size_t restarts_after = 0;
  for (const WheelTicks& ticks : out.wheels) {
    inside += ticks.stamp > Timestamp{5s} && ticks.stamp < Timestamp{10s} ? 1U : 0U;
    restarts_after += ticks.restarted && ticks.stamp >= Timestamp{10s} ? 1U : 0U;
  }
  EXPECT_EQ(inside, 0U);
  EXPECT_EQ(restarts_after, 1U);
  EXPECT_GT(out.wheels.size(), 900U);
}

TEST(SimulatedFaults, GivenTheBusGoneThenNothingCrossesItAndItComesBack) {
  const Decoded out = run_with(Device::can_bus, FaultKind::disconnect);
  std::size_t inside = 0;
  std::size_t after = 0;
  for (const WheelTicks& ticks : out.wheels) {
    inside += ticks.stamp > Timestamp{5s} + 5ms && ticks.stamp < Timestamp{10s} ? 1U : 0U;
    after += ticks.stamp > Timestamp{10s} ? 1U : 0U;
  }
  EXPECT_EQ(inside, 0U);
  EXPECT_GT(after, 490U);
}

}  // namespace
}  // namespace picolo::sim
