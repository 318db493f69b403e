// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A vehicle of known parameters and clocks, a driver, and the routine that listens: samples as the
/// drivers would deliver them, without wires and points.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "picolo/calibration/wheel_model.hpp"
#include "picolo/controller/calibration_routine.hpp"
#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::test {

struct Truth {
  DriveParameters drive{0.0752, 0.0748, 0.402, {0.205, -0.013, 0.035}};
  double lidar_age_s = 0.03;
  double gyro_age_s = 0.012;
  double gyro_bias_radps = 0.006;
  double gyro_scale = 1.02;  ///< true over measured
  double scan_m = 0.001;     ///< noise of one displacement
  double scan_rad = 0.0005;
  double gyro_radps = 0.003;
  bool has_gyro = true;
  double acceleration_radps2 = 8.0;  ///< of a wheel
};

/// What a driver does for a while: speeds of both wheels.
struct Leg {
  double left_radps = 0.0;
  double right_radps = 0.0;
  double seconds = 0.0;
};

/// How the wires of the encoders are connected.
enum class Wiring { right, left_dead, right_dead, swapped, left_reversed, right_reversed };

class Commissioning {
 public:
  static constexpr double kCounts = 4096.0;

  explicit Commissioning(const Truth& truth, std::uint64_t seed,
                         const CalibrationRoutineConfig& config = {},
                         CalibrationStore* store = nullptr)
      : truth_(truth), random_(seed), routine_(config, store) {
    instants_.push_back({});
  }

  [[nodiscard]] CalibrationRoutine& routine() { return routine_; }
  [[nodiscard]] double now_s() const { return instants_.back().t; }
  [[nodiscard]] Timestamp now() const { return stamp(now_s()); }
  void wire(Wiring wiring) { wiring_ = wiring; }
  /// From now on the vehicle is another one.
  void change(const DriveParameters& drive) { truth_.drive = drive; }
  std::size_t steps_per_frame = 2;
  std::size_t slices = 0;

  /// Drives a leg; ends early when the routine has ended.
  void drive(const Leg& leg) {
    const double end = now_s() + leg.seconds;
    while (now_s() < end - 1e-9 && routine_.running()) { tick(leg); }
  }
  void drive(const std::vector<Leg>& legs) {
    for (const Leg& leg : legs) { drive(leg); }
  }

  /// Stands, starts the routine, and does what it advises until it ends or `limit_s` has passed.
  void follow_advice(double limit_s = 900.0) {
    begin();
    while (routine_.running() && now_s() < limit_s) { drive(advised()); }
  }
  void begin() {
    static_cast<void>(routine_.start(now()));
    while (routine_.phase() == CalibrationPhase::standstill) { tick({}); }
  }
  /// Says that this is all, and stands until the routine has ended.
  void finish() {
    static_cast<void>(routine_.finish());
    for (int k = 0; k < 20'000 && routine_.running(); ++k) { tick({}); }
  }

  [[nodiscard]] Leg advised() {
    const double speed = random_.uniform(4.0, 7.0);
    const double turn = random_.uniform(1.5, 3.0);
    switch (routine_.advice()) {
      case DriveAdvice::turn_left: return {-turn, turn, 3.0};
      case DriveAdvice::turn_right: return {turn, -turn, 3.0};
      case DriveAdvice::drive_straight: return {speed, speed, 4.0};
      case DriveAdvice::change_speed: {
        brisk_ = !brisk_;
        return brisk_ ? Leg{-2.5, 2.5, 0.7} : Leg{2.5, -2.5, 0.7};
      }
      case DriveAdvice::drive_on: {
        brisk_ = !brisk_;
        return brisk_ ? Leg{0.7 * speed, speed, 3.0} : Leg{speed, 0.7 * speed, 3.0};
      }
      case DriveAdvice::none:
      case DriveAdvice::stand_still: break;
    }
    return {0.0, 0.0, 0.5};
  }

 private:
  struct Instant {
    double t = 0.0;
    Pose2d pose{};
    double left = 0.0;
    double right = 0.0;
    double omega = 0.0;
  };

  static Timestamp stamp(double t) { return Timestamp{from_seconds(100.0 + t)}; }

  /// Pose of the lidar at an instant of the past; before the beginning it stood.
  [[nodiscard]] Pose2d lidar_at(double t) const {
    const double index = std::max(0.0, t / kStep_s);
    const auto k = static_cast<std::size_t>(index);
    const Instant& a = instants_[std::min(k, instants_.size() - 1)];
    const Instant& b = instants_[std::min(k + 1, instants_.size() - 1)];
    const Pose2d step = between(a.pose, b.pose);
    const double share = index - static_cast<double>(k);
    const auto tangent = log_se2(step);
    const Pose2d part = exp_se2(
        Tangent2<double>{share * tangent.x_m, share * tangent.y_m, share * tangent.theta_rad});
    return a.pose * part * truth_.drive.base_T_lidar;
  }

  void tick(const Leg& leg) {
    const auto follow = [&](double& rate, double wanted) {
      const double most = truth_.acceleration_radps2 * kStep_s;
      rate += std::clamp(wanted - rate, -most, most);
    };
    follow(left_radps_, leg.left_radps);
    follow(right_radps_, leg.right_radps);
    const MotionSample motion{kStep_s, left_radps_, right_radps_, {}};
    const Pose2d step = base_motion(truth_.drive, motion);
    const Instant& last = instants_.back();
    instants_.push_back({last.t + kStep_s, last.pose * step, last.left + kStep_s * left_radps_,
                         last.right + kStep_s * right_radps_, step.theta_rad / kStep_s});
    ++ticks_;
    send_wheels();
    if (truth_.has_gyro) { send_gyro(); }
    if (ticks_ % 20 == 0) { send_scan(); }
    for (std::size_t k = 0; k < 2 * steps_per_frame; ++k) {
      if (!routine_.step(now())) { break; }
      ++slices;
    }
  }

  void send_wheels() {
    const auto count = [](double angle) {
      return static_cast<std::int64_t>(std::floor(angle / (2.0 * std::numbers::pi) * kCounts));
    };
    std::int64_t left = count(instants_.back().left);
    std::int64_t right = count(instants_.back().right);
    switch (wiring_) {
      case Wiring::right: break;
      case Wiring::left_dead: left = 0; break;
      case Wiring::right_dead: right = 0; break;
      case Wiring::swapped: std::swap(left, right); break;
      case Wiring::left_reversed: left = -left; break;
      case Wiring::right_reversed: right = -right; break;
    }
    WheelTicks ticks{.stamp = now()};
    ticks.ticks[0] = left;
    ticks.ticks[1] = right;
    routine_.add(ticks);
  }

  void send_gyro() {
    const auto back = static_cast<std::size_t>(truth_.gyro_age_s / kStep_s + 0.5);
    const std::size_t index = instants_.size() > back ? instants_.size() - 1 - back : 0;
    ImuSample sample{.stamp = now()};
    sample.rate_radps[2] =
        static_cast<float>(instants_[index].omega / truth_.gyro_scale + truth_.gyro_bias_radps +
                           truth_.gyro_radps * random_.gaussian());
    routine_.add(sample);
  }

  void send_scan() {
    const double begin = now_s() - 20 * kStep_s;
    Pose2d motion =
        between(lidar_at(begin - truth_.lidar_age_s), lidar_at(now_s() - truth_.lidar_age_s));
    const double x = random_.gaussian();
    const double y = random_.gaussian();
    const double theta = random_.gaussian();
    motion.x_m += truth_.scan_m * x;
    motion.y_m += truth_.scan_m * y;
    motion.theta_rad = wrap_angle(motion.theta_rad + truth_.scan_rad * theta);
    routine_.add_scan(stamp(begin), now(), motion);
  }

  static constexpr double kStep_s = 0.01;

  Truth truth_;
  Random random_;
  CalibrationRoutine routine_;
  std::vector<Instant> instants_;
  double left_radps_ = 0.0;
  double right_radps_ = 0.0;
  std::uint64_t ticks_ = 0;
  Wiring wiring_ = Wiring::right;
  bool brisk_ = false;
};

}  // namespace picolo::test
