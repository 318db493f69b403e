// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the devices of a recorded drive deliver.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "log_track.hpp"
#include "picolo/core/random.hpp"
#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/range_return.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::test {

/// One frame for every sample of the wheels, which `LogWheels` fills.
class LogBus final : public CanBus {
 public:
  explicit LogBus(Clock& clock) : clock_(clock) {}
  Result<CanFrame> receive() override {
    if (next_ > clock_.now()) { return Status::not_ready; }
    const CanFrame frame{.stamp = next_, .id = kId};
    next_ += 10ms;
    return frame;
  }
  Status transmit(const CanFrame& /*frame*/) override { return Status::ok; }
  [[nodiscard]] CanStatus status() const override { return {}; }
  static constexpr std::uint32_t kId = 0x181;

 private:
  Clock& clock_;
  Timestamp next_{10ms};
};

class LogWheels {
 public:
  explicit LogWheels(const LogTrack& track) : track_(track) {}
  bool consume(const CanFrame& frame) {
    if (frame.id != LogBus::kId) { return false; }
    const std::array<double, 2> metres = track_.metres_at(frame.stamp);
    sample_ = WheelTicks{.stamp = frame.stamp};
    for (std::size_t i = 0; i < 2; ++i) {
      sample_.ticks[i] = std::llround(metres[i] / kLogMetresPerCount);
    }
    fresh_ = true;
    return true;
  }
  Result<WheelTicks> take() {
    if (!fresh_) { return Status::not_ready; }
    fresh_ = false;
    return sample_;
  }
  Status service(Timestamp /*now*/) { return Status::ok; }

 private:
  const LogTrack& track_;
  WheelTicks sample_{};
  bool fresh_ = false;
};

/// Every scan when it was received; then one empty reading, so that its end is seen at once.
class LogLidar {
 public:
  LogLidar(const LogTrack& track, Clock& clock) : track_(track), clock_(clock) {}
  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<RangeReading> readings) {
    std::size_t count = 0;
    while (count < readings.size() && scan_ < track_.scans().size() &&
           track_.scans()[scan_].received <= clock_.now()) {
      const LogTrack::Scan& scan = track_.scans()[scan_];
      RangeReading& reading = readings[count++];
      reading = {.stamp = scan.stamp + static_cast<std::int64_t>(beam_) * scan.beam_step,
                 .starts_sweep = beam_ == 0};
      if (beam_ == scan.ranges_m.size()) {
        reading.starts_sweep = true;
        ++scan_;
        beam_ = 0;
        continue;
      }
      reading.range_m = scan.ranges_m[beam_] < scan.no_return_m ? scan.ranges_m[beam_] : 0.0F;
      reading.bearing_rad = scan.bearings_rad[beam_];
      ++beam_;
    }
    if (count == 0) { return Status::not_ready; }
    return count;
  }

 private:
  const LogTrack& track_;
  Clock& clock_;
  std::size_t scan_ = 0;
  std::size_t beam_ = 0;
};

/// 100 samples a second of a vehicle that stands upright; noise of a cheap sensor.
class LogImu {
 public:
  LogImu(const LogTrack& track, Clock& clock) : track_(track), clock_(clock) {}
  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<ImuSample> samples) {
    if (!track_.has_gyro() || samples.empty() || next_ > clock_.now()) { return Status::not_ready; }
    ImuSample& sample = samples[0] = {.stamp = next_};
    for (std::size_t i = 0; i < 3; ++i) {
      sample.rate_radps[i] = static_cast<float>(0.002 * random_.gaussian());
      sample.acceleration_mps2[i] = static_cast<float>(0.05 * random_.gaussian());
    }
    sample.rate_radps[2] += static_cast<float>(track_.yaw_rate_at(next_));
    sample.acceleration_mps2[2] += 9.81F;
    next_ += 10ms;
    return std::size_t{1};
  }

 private:
  const LogTrack& track_;
  Clock& clock_;
  Random random_{7, 0};
  Timestamp next_{10ms};
};

}  // namespace picolo::test
