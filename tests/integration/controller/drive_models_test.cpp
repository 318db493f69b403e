// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Vehicles with other wheels than two on an axle: the whole controller with the encoders of a
// forklift (one driven and steered wheel) and of four mecanum wheels, on a vehicle that scrubs
// sideways in its curves.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "picolo/odometry/ackermann_drive.hpp"
#include "picolo/odometry/mecanum_drive.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo::test {
namespace {

constexpr double kRadius_m = 0.1;
constexpr double kCounts = 4096.0;
constexpr AckermannDriveConfig kForklift{.wheel_radius_m = kRadius_m,
                                         .wheelbase_m = 0.8,
                                         .counts_per_revolution = kCounts,
                                         .steering_counts_per_turn = 36'000.0,
                                         .steering_zero_counts = 500.0,
                                         .max_steering_rad = 1.6,
                                         .driven = DrivenAxle::steered};
constexpr MecanumDriveConfig kMecanum{.radius_m = {kRadius_m, kRadius_m, kRadius_m, kRadius_m},
                                      .track_m = 0.5,
                                      .wheelbase_m = 0.4,
                                      .counts_per_revolution = kCounts};

enum class Wheels { steered, mecanum };

/// Encoders that roll with the true motion, sampled every 10 ms: a device as a customer writes it.
class TrueWheels {
 public:
  TrueWheels(const sim::Simulation& simulation, Wheels kind)
      : simulation_(simulation), kind_(kind) {}

  bool consume(const CanFrame& /*frame*/) { return false; }
  Status service(Timestamp now) {
    if (now - last_.stamp < 10ms) { return Status::ok; }
    const auto truth = simulation_.truth(now);
    if (!truth) { return Status::ok; }
    roll(log_se2(between(last_.world_T_base, truth->world_T_base)), truth->twist);
    last_ = *truth;
    sample_ = WheelTicks{.stamp = now};
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      sample_.ticks[k] = std::llround(counts_[k]);
    }
    fresh_ = true;
    return Status::ok;
  }
  Result<WheelTicks> take() {
    if (!fresh_) { return Status::not_ready; }
    fresh_ = false;
    return sample_;
  }

 private:
  void roll(const Tangent2<double>& path, const Twist2& twist) {
    constexpr double kCountsPerM = kCounts / (2.0 * std::numbers::pi * kRadius_m);
    if (!begun_) {
      begun_ = true;
      counts_[1] = kind_ == Wheels::steered ? kForklift.steering_zero_counts : 0.0;
      return;
    }
    if (kind_ == Wheels::steered) {
      counts_[0] += std::hypot(path.x_m, kForklift.wheelbase_m * path.theta_rad) * kCountsPerM;
      const double sideways = kForklift.wheelbase_m * static_cast<double>(twist.omega_radps);
      const double steering_rad = std::atan2(sideways, static_cast<double>(twist.x_mps));
      counts_[1] = kForklift.steering_zero_counts +
                   steering_rad * kForklift.steering_counts_per_turn / (2.0 * std::numbers::pi);
      return;
    }
    const double arm_m = (kMecanum.track_m + kMecanum.wheelbase_m) / 2.0;
    const double turn_m = arm_m * path.theta_rad;
    const std::array<double, 4> rolled_m{path.x_m - path.y_m - turn_m, path.x_m + path.y_m + turn_m,
                                         path.x_m + path.y_m - turn_m,
                                         path.x_m - path.y_m + turn_m};
    for (std::size_t k = 0; k < counts_.size(); ++k) { counts_[k] += rolled_m[k] * kCountsPerM; }
  }

  const sim::Simulation& simulation_;
  Wheels kind_;
  sim::Truth last_{};
  std::array<double, 4> counts_{};
  WheelTicks sample_{};
  bool begun_ = false;
  bool fresh_ = false;
};

struct Course {
  double worst_m = 0.0;
  double odometry_m = 0.0;  ///< of odometry alone, at the end
  int tracking = 0;
  int frames = 0;
};

Course drive(Wheels kind, double scrub_s) {
  const auto simulation = std::make_unique<sim::Simulation>(
      sim::SimulationConfig{.seed = 7, .vehicle = {.slip_sigma = 0.0, .scrub_s = scrub_s}});
  TrueWheels wheels{*simulation, kind};
  Ld06 lidar{simulation->lidar_port()};
  WitMotion imu{simulation->imu_port()};
  EventRing events;
  const ControllerConfig config = simulated_vehicle_config();
  DriveModelOf<AckermannDrive> steered{kForklift};
  DriveModelOf<MecanumDrive> mecanum{kMecanum};
  ControllerServices services;
  services.drive = &mecanum;
  if (kind == Wheels::steered) { services.drive = &steered; }
  using Robot = Controller<RoomProfile, TrueWheels, Ld06, WitMotion>;
  const auto robot =
      std::make_unique<Robot>(Board{simulation->can(), simulation->clock(),
                                    simulation->cycle_counter(), simulation->watchdog()},
                              wheels, lidar, imu, events, config, services);
  EXPECT_EQ(robot->start(), Status::ok);
  Course course;
  const Pose2d start = simulation->config().scene.world_T_start;
  while (simulation->now() < Timestamp{30s}) {
    simulation->advance_to(robot->next_frame());
    static_cast<void>(robot->run_frame());
    const PoseEstimate& estimate = robot->estimate();
    const auto truth = simulation->truth(estimate.stamp);
    if (!truth || simulation->now() < Timestamp{3s}) { continue; }
    const Pose2d expected = between(start, truth->world_T_base);
    const auto distance = [&expected](const Pose2d& pose) {
      return std::hypot(pose.x_m - expected.x_m, pose.y_m - expected.y_m);
    };
    course.worst_m = std::max(course.worst_m, distance(estimate.map_T_base));
    course.odometry_m = distance(estimate.odom_T_base);
    course.tracking += estimate.state == HealthState::tracking ? 1 : 0;
    ++course.frames;
  }
  std::cout << "worst " << course.worst_m << " m, odometry alone " << course.odometry_m
            << " m, tracking " << course.tracking << " of " << course.frames << " frames\n";
  return course;
}

TEST(DriveModels, GivenASteeredDrivingWheelThenThePoseHolds) {
  const Course course = drive(Wheels::steered, 0.0);
  EXPECT_LT(course.worst_m, 0.06);
  EXPECT_LT(course.odometry_m, 0.15);
  EXPECT_GT(course.tracking, course.frames * 95 / 100);
}

TEST(DriveModels, GivenMecanumWheelsThenTheirSidewaysMotionIsInTheOdometry) {
  const Course course = drive(Wheels::mecanum, 0.3);
  EXPECT_LT(course.worst_m, 0.06);
  EXPECT_LT(course.odometry_m, 0.15);
  EXPECT_GT(course.tracking, course.frames * 95 / 100);
}

}  // namespace
}  // namespace picolo::test
