// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/pose_composer.hpp"

#include <algorithm>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

float square(float x) {
  return x * x;
}

float magnitude(float x) {
  return x < 0.0F ? -x : x;
}

}  // namespace

PoseComposer::PoseComposer(const ControllerConfig& config)
    : growth_(config.growth),
      max_prediction_(config.max_prediction),
      trust_(config.trust),
      map_T_odom_(config.start_map_T_base),
      reference_map_T_base_(config.start_map_T_base) {}

void PoseComposer::travel(const Pose2d& odom_T_base) {
  const Pose2f moved = to_f32(between(last_odom_T_base_, odom_T_base));
  last_odom_T_base_ = odom_T_base;
  const float distance_m = hypotenuse(moved.x_m, moved.y_m);
  const float turn_rad = magnitude(moved.theta_rad);
  for (Way* way : {&since_match_, &since_start_}) {
    way->distance_m += distance_m;
    way->turn_rad += turn_rad;
  }
}

void PoseComposer::correct(const MatchVerdict& verdict, const StampedPose& odometry) {
  const Pose2d corrected = verdict.map_T_base * inverse(verdict.odom_T_base);
  const Pose2d& odom_T_base = odometry.odom_T_base;
  last_jump_ = to_f32(between(map_T_odom_ * odom_T_base, corrected * odom_T_base));
  turned_by_gyro_ = verdict.turned_by_gyro;
  jumped_ = hypotenuse(last_jump_.x_m, last_jump_.y_m) > trust_.max_correction_m ||
            magnitude(last_jump_.theta_rad) > turn_factor() * trust_.max_correction_rad;
  pull_ = {trust_.pull_kept * pull_.x_m + last_jump_.x_m,
           trust_.pull_kept * pull_.y_m + last_jump_.y_m,
           trust_.pull_kept * pull_.theta_rad + last_jump_.theta_rad};
  map_T_odom_ = corrected;
  reference_ = verdict.reference;
  reference_odom_T_base_ = verdict.odom_T_base;
  reference_map_T_base_ = verdict.map_T_base;
  reference_covariance_ = verdict.covariance;
  // Fractions of a second have passed since the reference: the chord stands for the way.
  const Pose2f moved = to_f32(between(verdict.odom_T_base, odom_T_base));
  since_match_ = {hypotenuse(moved.x_m, moved.y_m), magnitude(moved.theta_rad)};
  ++matches_;
}

void PoseComposer::set_pose(const Pose2d& map_T_base, const StampedPose& odometry) {
  map_T_odom_ = map_T_base * inverse(odometry.odom_T_base);
  reference_ = odometry.stamp;
  reference_odom_T_base_ = odometry.odom_T_base;
  reference_map_T_base_ = map_T_base;
  reference_covariance_ = Matrix3f::diagonal(square(growth_.set_pose_m), square(growth_.set_pose_m),
                                             square(growth_.set_pose_rad));
  since_match_ = {};
  last_jump_ = {};
  pull_ = {};
  jumped_ = false;
}

PoseEstimate PoseComposer::compose(Timestamp now, const StampedPose& odometry,
                                   const Twist2& base_twist) {
  travel(odometry.odom_T_base);
  const Duration ahead = std::clamp(Duration{now - odometry.stamp}, Duration{0}, max_prediction_);
  const double ahead_s = to_seconds_f64(ahead);
  const Pose2d predicted =
      exp_se2(Tangent2<double>{static_cast<double>(base_twist.x_mps) * ahead_s,
                               static_cast<double>(base_twist.y_mps) * ahead_s,
                               static_cast<double>(base_twist.omega_radps) * ahead_s});
  PoseEstimate estimate;
  estimate.stamp = odometry.stamp + ahead;
  estimate.odom_T_base = odometry.odom_T_base * predicted;
  estimate.map_T_base = map_T_odom_ * estimate.odom_T_base;
  estimate.base_twist = base_twist;
  estimate.last_jump = last_jump_;
  estimate.match_age = estimate.stamp - reference_;
  estimate.matches = matches_;

  // map_T_base(now) = map_T_base(t) * base(t)_T_base(now): the match's error is carried along, that
  // of the way is added.
  const Pose2f at_match{0.0F, 0.0F, static_cast<float>(reference_map_T_base_.theta_rad)};
  const Pose2f moved = to_f32(between(reference_odom_T_base_, estimate.odom_T_base));
  const float position_variance = square(growth_.position_per_m * since_match_.distance_m) +
                                  square(growth_.position_per_rad_m * since_match_.turn_rad);
  const float heading_variance = square(growth_.heading_per_m_rad * since_match_.distance_m) +
                                 square(growth_.heading_per_rad * since_match_.turn_rad);
  estimate.match_covariance =
      sum(propagate(compose_jacobian_left(at_match, moved), reference_covariance_),
          Matrix3f::diagonal(position_variance, position_variance, heading_variance));
  const float drift_variance = square(growth_.drift_per_m * since_start_.distance_m);
  estimate.drift_covariance =
      Matrix3f::diagonal(drift_variance, drift_variance,
                         square(growth_.drift_heading_per_m_rad * since_start_.distance_m));
  return estimate;
}

bool PoseComposer::pulled() const {
  return hypotenuse(pull_.x_m, pull_.y_m) > trust_.max_pull_m ||
         magnitude(pull_.theta_rad) > turn_factor() * trust_.max_pull_rad;
}

float PoseComposer::turn_factor() const {
  return turned_by_gyro_ ? 1.0F : trust_.without_gyro;
}

std::int32_t PoseComposer::jump_mm() const {
  return round_to_i32(hypotenuse(last_jump_.x_m, last_jump_.y_m) * 1000.0F, 0, 1'000'000'000);
}

}  // namespace picolo::inline v0
