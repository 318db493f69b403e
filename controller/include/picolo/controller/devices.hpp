// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the controller asks of a board and of its devices. Every driver of drivers/ satisfies one
/// of these concepts.
#pragma once

#include <concepts>
#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/watchdog.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/range_return.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// The parts of a port that the controller itself uses; drivers hold their serial ports.
struct Board {
  CanBus& can;
  Clock& clock;
  CycleCounter& cycle_counter;
  Watchdog& watchdog;
};

/// Wheel encoders, on the shared CAN bus or not. The controller drains the bus and offers every
/// frame. `consume`: true when the frame was meant for it. `take`: the newest complete sample,
/// once. `service`: called every cycle after the drain, sends what the protocol asks for, or reads
/// the counters of encoders that are not on the bus.
template <typename W>
concept WheelDevice = requires(W& wheels, const CanFrame& frame, Timestamp now) {
  { wheels.consume(frame) } -> std::same_as<bool>;
  { wheels.take() } -> std::same_as<Result<WheelTicks>>;
  { wheels.service(now) } -> std::same_as<Status>;
};

/// Reads at most `max_bytes` and writes the samples that they complete. `not_ready`: none.
/// `disconnected`: the line is gone. Lidars and IMUs that must be asked also have `service(now)`,
/// which is called every cycle.
template <typename L>
concept LidarDevice = requires(L& lidar, std::size_t max_bytes, std::span<RangeReading> readings) {
  { lidar.poll(max_bytes, readings) } -> std::same_as<Result<std::size_t>>;
};

template <typename I>
concept ImuDevice = requires(I& imu, std::size_t max_bytes, std::span<ImuSample> samples) {
  { imu.poll(max_bytes, samples) } -> std::same_as<Result<std::size_t>>;
};

/// For vehicles without an IMU; set HealthConfig::expects_gyro to false then.
struct NoImu {
  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<ImuSample> /*samples*/) {
    return Status::not_ready;
  }
};

/// How the devices are numbered in events.
enum class DeviceIndex : std::uint8_t { wheels, lidar, imu };
inline constexpr std::size_t kDeviceCount = 3;

}  // namespace picolo::inline v0
