// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <memory>
#include <span>

#include "picolo/controller/controller.hpp"
#include "picolo/core/version.hpp"
#include "picolo/picolo.h"

namespace {

using namespace picolo;

Timestamp at(std::int64_t stamp_us) {
  return Timestamp{Duration{stamp_us}};
}
std::int64_t us_of(Timestamp stamp) {
  return stamp.time_since_epoch().count();
}

/// Time is what the caller says; how long a task takes is not measured.
class ToldTime final : public Clock, public CycleCounter {
 public:
  Timestamp now() override { return now_; }
  std::uint32_t cycles() override { return 0; }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1; }
  void set(std::int64_t now_us) { now_ = at(now_us); }

 private:
  Timestamp now_{};
};

class NoWatchdog final : public Watchdog {
 public:
  void stroke() override {}
};

/// The wheels' samples, told to the controller as a bus of their own: a frame a sample.
class FedWheels final : public CanBus {
 public:
  [[nodiscard]] bool push(const WheelTicks& ticks) { return queue_.push(ticks); }
  [[nodiscard]] std::uint32_t lost() const { return queue_.dropped(); }

  Result<CanFrame> receive() override {
    if (!queue_.pop(taken_)) { return Status::not_ready; }
    return CanFrame{.stamp = taken_.stamp};
  }
  Status transmit(const CanFrame& /*frame*/) override { return Status::ok; }
  [[nodiscard]] CanStatus status() const override { return {}; }

  bool consume(const CanFrame& /*frame*/) { return true; }
  Result<WheelTicks> take() { return taken_; }
  Status service(Timestamp /*now*/) { return Status::ok; }

 private:
  SpscRing<WheelTicks, 16> queue_;
  WheelTicks taken_{};
};

template <typename Sample, std::size_t Capacity>
class FedSamples {
 public:
  [[nodiscard]] bool push(const Sample& sample) { return queue_.push(sample); }
  [[nodiscard]] std::uint32_t lost() const { return queue_.dropped(); }

  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<Sample> samples) {
    std::size_t count = 0;
    while (count < samples.size() && queue_.pop(samples[count])) { ++count; }
    if (count == 0) { return Status::not_ready; }
    return count;
  }

 private:
  SpscRing<Sample, Capacity> queue_;
};

using FedLidar = FedSamples<RangeReading, 256>;
using FedImu = FedSamples<ImuSample, 16>;

ControllerConfig config_of(const picolo_config& given) {
  ControllerConfig config;
  config.drive = {.left_radius_m = given.left_radius_m,
                  .right_radius_m = given.right_radius_m,
                  .track_m = given.track_m,
                  .counts_per_revolution = given.counts_per_revolution};
  config.undistort.base_T_lidar = {given.lidar_x_m, given.lidar_y_m, given.lidar_yaw_rad};
  config.undistort.limits = {.min_m = given.lidar_min_m, .max_m = given.lidar_max_m};
  config.start_map_T_base = {given.start_x_m, given.start_y_m, given.start_theta_rad};
  config.dead_reckoning.use_gyro = given.has_gyro;
  config.health.expects_gyro = given.has_gyro;
  config.frames_out.enabled = false;
  return config;
}

picolo_status status_of(Status status) {
  if (is_ok(status)) { return PICOLO_OK; }
  if (status == Status::not_ready) { return PICOLO_NOT_READY; }
  return status == Status::full ? PICOLO_FULL : PICOLO_INVALID_ARGUMENT;
}

picolo_status status_of(bool pushed) {
  return pushed ? PICOLO_OK : PICOLO_FULL;
}

static_assert(static_cast<int>(Status::full) == PICOLO_FULL);
static_assert(static_cast<int>(Status::invalid_argument) == PICOLO_INVALID_ARGUMENT);
static_assert(static_cast<int>(HealthState::tracking) == PICOLO_TRACKING);
static_assert(static_cast<int>(HealthState::fault) == PICOLO_FAULT);
static_assert(static_cast<int>(HealthState::relocalising) == PICOLO_RELOCALISING);

}  // namespace

struct picolo_vehicle {
  explicit picolo_vehicle(const ControllerConfig& config)
      : controller({wheels, time, time, watchdog}, wheels, lidar, imu, events, config) {}

  ToldTime time;
  NoWatchdog watchdog;
  FedWheels wheels;
  FedLidar lidar;
  FedImu imu;
  EventRing events;
  Controller<RoomProfile, FedWheels, FedLidar, FedImu> controller;
};
static_assert(sizeof(picolo_vehicle) <= sizeof(picolo_storage));
static_assert(alignof(picolo_vehicle) <= alignof(picolo_storage));

extern "C" {

void picolo_default_config(picolo_config* config) {
  const ControllerConfig defaults;
  *config = {};
  config->left_radius_m = defaults.drive.left_radius_m;
  config->right_radius_m = defaults.drive.right_radius_m;
  config->track_m = defaults.drive.track_m;
  config->counts_per_revolution = defaults.drive.counts_per_revolution;
  config->lidar_min_m = defaults.undistort.limits.min_m;
  config->lidar_max_m = defaults.undistort.limits.max_m;
  config->has_gyro = true;
}

picolo_vehicle* picolo_create(picolo_storage* storage, const picolo_config* config) {
  const ControllerConfig wanted = config_of(*config);
  if (!wanted.valid()) { return nullptr; }
  void* const memory = storage;
  return std::construct_at(static_cast<picolo_vehicle*>(memory), wanted);
}

picolo_status picolo_start(picolo_vehicle* vehicle, int64_t now_us) {
  vehicle->time.set(now_us);
  return status_of(vehicle->controller.start());
}

int64_t picolo_next_frame_us(const picolo_vehicle* vehicle) {
  return us_of(vehicle->controller.next_frame());
}

picolo_status picolo_run_frame(picolo_vehicle* vehicle, int64_t now_us) {
  vehicle->time.set(now_us);
  return status_of(vehicle->controller.run_frame());
}

picolo_status picolo_add_wheels(picolo_vehicle* vehicle, int64_t stamp_us, int64_t left_counts,
                                int64_t right_counts) {
  WheelTicks ticks{.stamp = at(stamp_us)};
  ticks.ticks[0] = left_counts;
  ticks.ticks[1] = right_counts;
  return status_of(vehicle->wheels.push(ticks));
}

picolo_status picolo_add_beam(picolo_vehicle* vehicle, int64_t stamp_us, float range_m,
                              float bearing_rad, bool starts_sweep) {
  return status_of(vehicle->lidar.push({at(stamp_us), range_m, bearing_rad, starts_sweep}));
}

picolo_status picolo_add_imu(picolo_vehicle* vehicle, int64_t stamp_us,
                             const float acceleration_mps2[3], const float rate_radps[3]) {
  ImuSample sample{.stamp = at(stamp_us)};
  std::copy_n(acceleration_mps2, 3, sample.acceleration_mps2.begin());
  std::copy_n(rate_radps, 3, sample.rate_radps.begin());
  return status_of(vehicle->imu.push(sample));
}

uint32_t picolo_lost_samples(const picolo_vehicle* vehicle) {
  return vehicle->wheels.lost() + vehicle->lidar.lost() + vehicle->imu.lost();
}

bool picolo_read_pose(const picolo_vehicle* vehicle, picolo_pose* pose) {
  PoseEstimate estimate;
  if (!vehicle->controller.read_pose(estimate)) { return false; }
  pose->stamp_us = us_of(estimate.stamp);
  pose->x_m = estimate.map_T_base.x_m;
  pose->y_m = estimate.map_T_base.y_m;
  pose->theta_rad = estimate.map_T_base.theta_rad;
  pose->odom_x_m = estimate.odom_T_base.x_m;
  pose->odom_y_m = estimate.odom_T_base.y_m;
  pose->odom_theta_rad = estimate.odom_T_base.theta_rad;
  pose->speed_mps = estimate.base_twist.x_mps;
  pose->yaw_rate_radps = estimate.base_twist.omega_radps;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      pose->covariance[3 * row + column] = estimate.match_covariance(row, column);
      pose->drift_covariance[3 * row + column] = estimate.drift_covariance(row, column);
    }
  }
  pose->match_age_us = estimate.match_age.count();
  pose->matches = estimate.matches;
  pose->health = static_cast<std::uint8_t>(estimate.state);
  pose->reason = static_cast<std::uint8_t>(estimate.reason);
  return true;
}

const char* picolo_health_name(uint8_t health) {
  return to_string(static_cast<HealthState>(health));
}

const char* picolo_reason_name(uint8_t reason) {
  return to_string(static_cast<HealthReason>(reason));
}

uint32_t picolo_version(void) {
  return kVersionMajor * 10'000 + kVersionMinor * 100 + kVersionPatch;
}

}  // extern "C"
