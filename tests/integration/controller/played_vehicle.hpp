// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The installed controller with devices that a test plays: a vehicle that can be lifted, and a
/// lidar that sees what the test wants it to see.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/controller/controller.hpp"
#include "picolo/geometry/angle.hpp"
#include "support/fake_can_bus.hpp"
#include "support/walls.hpp"

namespace picolo::test {

/// A line whose samples have arrived when the test says so.
template <typename Sample>
struct PlayedLine {
  std::deque<Sample> waiting;
  Result<std::size_t> poll(std::size_t /*max_bytes*/, std::span<Sample> samples) {
    std::size_t count = 0;
    for (; count < samples.size() && !waiting.empty(); ++count) {
      samples[count] = waiting.front();
      waiting.pop_front();
    }
    if (count == 0) { return Status::not_ready; }
    return count;
  }
};

/// A frame on the bus brings the sample that waits.
struct PlayedWheels {
  std::deque<WheelTicks> waiting;
  bool consume(const CanFrame& frame) { return frame.id == 0x181; }
  Result<WheelTicks> take() {
    if (waiting.empty()) { return Status::not_ready; }
    const WheelTicks ticks = waiting.front();
    waiting.pop_front();
    return ticks;
  }
  Status service(Timestamp /*now*/) { return Status::ok; }
};

struct PlayedClock final : Clock {
  Timestamp time{1s};
  Timestamp now() override { return time; }
};
struct NoCycles final : CycleCounter {
  std::uint32_t cycles() override { return 0; }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1; }
};
struct NoWatchdog final : Watchdog {
  void stroke() override {}
};

/// Ten sweeps a second of 360 beams, a hundred samples a second of wheels and gyro, nearly exact;
/// drives a circle of 1.4 m once in 18 s.
class PlayedVehicle {
 public:
  using Robot =
      Controller<RoomProfile, PlayedWheels, PlayedLine<RangeReading>, PlayedLine<ImuSample>>;
  static constexpr int kBeams = 360;
  /// What the lidar says of beam k of a sweep, standing there; by default the range to the wall.
  using See = std::function<float(const Pose2d& world_T_base, int sweep, int k)>;

  explicit PlayedVehicle(const std::vector<Wall>& walls, const Pose2d& world_T_base,
                         const ControllerConfig& config)
      : truth{world_T_base},
        walls_{walls},
        robot_{std::make_unique<Robot>(Board{can_, clock_, cycles_, watchdog_}, wheels_, lidar_,
                                       imu_, events_, config)} {}

  [[nodiscard]] static ControllerConfig config_at(const Pose2d& map_T_base) {
    ControllerConfig config;
    config.start_map_T_base = map_T_base;
    return config;
  }
  [[nodiscard]] static float bearing_rad(int k) {
    return static_cast<float>(-std::numbers::pi + 2.0 * std::numbers::pi * k / kBeams);
  }
  [[nodiscard]] float range_m(const Pose2d& at, int k) const {
    const double angle = at.theta_rad + static_cast<double>(bearing_rad(k));
    return static_cast<float>(cast(walls_, at.x_m, at.y_m, angle));
  }

  Robot& robot() { return *robot_; }
  [[nodiscard]] const PoseEstimate& estimate() const { return robot_->estimate(); }
  [[nodiscard]] double error_m() const {
    return std::hypot(estimate().map_T_base.x_m - truth.x_m, estimate().map_T_base.y_m - truth.y_m);
  }
  [[nodiscard]] bool wrong() const {
    const double turn = wrap_angle(estimate().map_T_base.theta_rad - truth.theta_rad);
    return error_m() > 0.20 || std::abs(turn) > 3.0 * std::numbers::pi / 180.0;
  }

  void start() { ASSERT_EQ(robot_->start(), Status::ok); }
  /// Drives until so long after the start; `judge` sees every publication. Publications that are
  /// the third or later in a row to be wrong while tracking count as silent from `heard` on.
  void until(Duration elapsed, const std::function<void()>& judge = {}, Duration heard = 0s) {
    for (; elapsed_ < elapsed; elapsed_ += kFrame) {
      live();
      clock_.time = std::max(clock_.time, robot_->next_frame());
      ASSERT_EQ(robot_->run_frame(), Status::ok);
      const bool bad = wrong() && estimate().state == HealthState::tracking && elapsed_ >= heard;
      wrong_in_a_row_ = bad ? wrong_in_a_row_ + 1 : 0;
      silent_wrong += wrong_in_a_row_ >= 3 ? 1 : 0;
      if (judge) { judge(); }
    }
  }

  Pose2d truth;
  See see;
  bool repeats_sweeps = false;  ///< every second sweep says what the one before has said
  double speed_mps = 0.5;
  double omega_radps = 0.35;
  int silent_wrong = 0;

 private:
  static constexpr Duration kFrame = 5ms;
  static constexpr int kBeamsPerFrame = kBeams / 20;

  void live() {
    const Timestamp from = clock_.time;
    const double step_s = 0.005;
    const Pose2d step = exp_se2(Tangent2<double>{speed_mps * step_s, 0.0, omega_radps * step_s});
    for (int i = 0; i < kBeamsPerFrame; ++i, ++beam_) {
      const int k = beam_ % kBeams;
      const int sweep = beam_ / kBeams;
      const float said = see ? see(truth, sweep, k) : range_m(truth, k);
      float& last = said_[static_cast<std::size_t>(k)];
      if (!repeats_sweeps || sweep % 2 == 0) { last = said; }
      lidar_.waiting.push_back({.stamp = from + i * (kFrame / kBeamsPerFrame),
                                .range_m = last,
                                .bearing_rad = bearing_rad(k),
                                .starts_sweep = k == 0});
    }
    truth = truth * step;
    left_m_ += (speed_mps - omega_radps * 0.25) * step_s;
    right_m_ += (speed_mps + omega_radps * 0.25) * step_s;
    even_ = !even_;
    if (!even_) { return; }
    const Timestamp now = from + kFrame;
    const double counts_per_m = 4096.0 / (2.0 * std::numbers::pi * 0.1);
    wheels_.waiting.push_back(
        {.stamp = now,
         .ticks = {std::llround(left_m_ * counts_per_m), std::llround(right_m_ * counts_per_m)}});
    can_.arrives(can_frame(now, 0x181));
    ImuSample sample{.stamp = now};
    flicker_ = -flicker_;  // what repeats itself to the bit counts as stuck
    sample.rate_radps[2] = static_cast<float>(omega_radps) + flicker_;
    sample.acceleration_mps2 = {flicker_, 0.0F, 9.81F};
    imu_.waiting.push_back(sample);
  }

  std::vector<Wall> walls_;
  FakeCanBus can_;
  PlayedClock clock_;
  NoCycles cycles_;
  NoWatchdog watchdog_;
  PlayedWheels wheels_;
  PlayedLine<RangeReading> lidar_;
  PlayedLine<ImuSample> imu_;
  EventRing events_{};
  std::unique_ptr<Robot> robot_;
  std::array<float, kBeams> said_{};
  Duration elapsed_{0};
  int beam_ = 0;
  double left_m_ = 0.0;
  double right_m_ = 0.0;
  bool even_ = false;
  float flicker_ = 1e-4F;
  int wrong_in_a_row_ = 0;
};

}  // namespace picolo::test
