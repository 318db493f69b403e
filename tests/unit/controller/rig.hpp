// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The controller with devices that a test plays.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <vector>

#include "picolo/controller/controller.hpp"
#include "small_profile.hpp"
#include "support/fake_can_bus.hpp"

namespace picolo::test {

struct FakeClock final : Clock {
  Timestamp time{1s};
  Timestamp now() override { return time; }
};
struct FakeCycles final : CycleCounter {
  std::uint32_t cycles() override { return 0; }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1; }
};
struct FakeWatchdog final : Watchdog {
  int strokes = 0;
  void stroke() override { ++strokes; }
};

/// Every frame 0x181 is a complete sample with the count in its first byte.
struct FakeWheels {
  Result<WheelTicks> sample{Status::not_ready};
  std::vector<Timestamp> serviced;
  bool consume(const CanFrame& frame) {
    if (frame.id != 0x181) { return false; }
    sample = WheelTicks{.stamp = frame.stamp, .ticks = {frame.data[0], frame.data[0]}};
    return true;
  }
  Result<WheelTicks> take() {
    const Result<WheelTicks> taken = sample;
    sample = Status::not_ready;
    return taken;
  }
  Status service(Timestamp now) {
    serviced.push_back(now);
    return Status::ok;
  }
};

template <typename Sample>
struct FakeSerialDevice {
  std::deque<Sample> waiting;
  std::vector<std::size_t> asked_bytes;
  Status when_empty = Status::not_ready;
  FakeClock* clock = nullptr;
  Duration slow{0};  ///< how long a poll takes
  Result<std::size_t> poll(std::size_t max_bytes, std::span<Sample> samples) {
    asked_bytes.push_back(max_bytes);
    if (clock != nullptr) { clock->time += slow; }
    std::size_t count = 0;
    for (; count < samples.size() && !waiting.empty(); ++count) {
      samples[count] = waiting.front();
      waiting.pop_front();
    }
    if (count == 0) { return when_empty; }
    return count;
  }
};
using FakeLidar = FakeSerialDevice<RangeReading>;
using FakeImu = FakeSerialDevice<ImuSample>;

static_assert(WheelDevice<FakeWheels> && LidarDevice<FakeLidar> && ImuDevice<FakeImu> &&
              ImuDevice<NoImu>);

template <ImuDevice Imu>
struct Rig {
  FakeCanBus can;
  FakeClock clock;
  FakeCycles cycles;
  FakeWatchdog watchdog;
  FakeWheels wheels;
  FakeLidar lidar;
  Imu imu;
  EventRing events{};
  std::unique_ptr<Controller<SmallProfile, FakeWheels, FakeLidar, Imu>> owner;
  Controller<SmallProfile, FakeWheels, FakeLidar, Imu>& controller;

  explicit Rig(const ControllerConfig& config = {}, const ControllerServices& services = {})
      : owner(std::make_unique<Controller<SmallProfile, FakeWheels, FakeLidar, Imu>>(
            Board{can, clock, cycles, watchdog}, wheels, lidar, imu, events, config, services)),
        controller(*owner) {
    lidar.clock = &clock;
    EXPECT_EQ(controller.start(), Status::ok);
  }
  void run_frame() {
    clock.time = std::max(clock.time, controller.next_frame());
    ASSERT_EQ(controller.run_frame(), Status::ok);
  }
};

}  // namespace picolo::test
